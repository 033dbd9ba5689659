// SPDX-License-Identifier: GPL-3.0-or-later
#include <vmap/exporters/output_info.h>
#include <vmap/printable.h>

#include <Imath/ImathBox.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace vmap {
namespace {

/// Relative luminance of linear Rec.709.
float luminance(const Imath::C3f& color) {
    return 0.2126F * color.x + 0.7152F * color.y + 0.0722F * color.z;
}

}  // namespace

std::string_view name_of(UpAxis up) {
    return up == UpAxis::y ? "y" : "z";
}

std::string_view name_of(LightUnits units) {
    switch (units) {
        case LightUnits::spec:
            return "spec";
        case LightUnits::raw:
            return "raw";
        case LightUnits::compat:
            break;
    }
    return "compat";
}

std::string header_text(std::string_view name) {
    constexpr std::size_t max_length = 255;
    std::string text = printable(name);
    if (text.size() > max_length) {
        std::size_t end = max_length;
        while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;  // not inside a UTF-8 sequence
        text.resize(end);
    }
    return text;
}

Imath::C3f radiance_at(const LitCloud& cloud, std::size_t point) {
    const PointCloud& points = cloud.points;
    Imath::C3f radiance(0, 0, 0);
    if (!points.emission.empty()) radiance += points.emission[point];
    if (!points.albedo.empty() && !cloud.irradiance.empty())
        radiance += points.albedo[point] * cloud.irradiance[point] * std::numbers::inv_pi_v<float>;
    return radiance;
}

float radius_at(const PointCloud& cloud, std::size_t point) {
    return cloud.areas.empty() ? 0 : std::sqrt(cloud.areas[point] * std::numbers::inv_pi_v<float>);
}

double mean_spacing(const PointCloud& cloud) {
    const auto count = static_cast<double>(cloud.size());
    if (cloud.size() < 2) return 0;
    double area = 0;
    for (const float a : cloud.areas) area += a;
    if (area > 0) return std::sqrt(area / count);

    Imath::Box3d box;
    for (const Imath::V3f& position : cloud.positions) box.extendBy(Imath::V3d(position));
    const Imath::V3d size = box.size();
    const double faces = 2 * (size.x * size.y + size.y * size.z + size.z * size.x);
    return faces > 0 ? std::sqrt(faces / count) : size.length() / (count - 1);
}

Imath::V3d output_offset(const PointCloud& cloud) {
    constexpr double allowed_share_of_spacing = 0.01;
    constexpr double float_rounding = 0x1p-24;
    if (cloud.origin == Imath::V3d(0, 0, 0)) return cloud.origin;

    Imath::Box3f box;
    for (const Imath::V3f& position : cloud.positions) box.extendBy(position);
    const Imath::V3d corners[] = {cloud.origin + Imath::V3d(box.min), cloud.origin + Imath::V3d(box.max)};
    double largest = 0;
    for (const Imath::V3d& corner : corners)
        largest = std::max({largest, std::abs(corner.x), std::abs(corner.y), std::abs(corner.z)});
    const bool floats_suffice = largest * float_rounding <= allowed_share_of_spacing * mean_spacing(cloud);
    return floats_suffice ? Imath::V3d(0, 0, 0) : cloud.origin;
}

double automatic_exposure(const LitCloud& cloud) {
    constexpr double share_below_white = 0.95;
    constexpr double white = 0.8;

    // (luminance, area) of a few points, evenly picked: enough for a percentile.
    constexpr std::size_t max_samples = 65536;
    const std::size_t step = std::max<std::size_t>(1, cloud.points.size() / max_samples);
    std::vector<std::pair<float, float>> samples;
    double total_area = 0;
    for (std::size_t i = 0; i < cloud.points.size(); i += step) {
        if (cloud.points.emits() && luminance(cloud.points.emission[i]) > 0) continue;
        const float area = cloud.points.areas.empty() ? 1 : cloud.points.areas[i];
        const float value = luminance(radiance_at(cloud, i));
        if (!(value > 0) || !std::isfinite(value)) continue;
        samples.emplace_back(value, area);
        total_area += area;
    }
    std::sort(samples.begin(), samples.end());

    double area = 0;
    for (const auto& [value, sample_area] : samples) {
        area += sample_area;
        if (area >= share_below_white * total_area) return white / value;
    }
    return 1;
}

}  // namespace vmap
