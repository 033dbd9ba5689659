// SPDX-License-Identifier: GPL-3.0-or-later
#include "flip_filters.h"

#include <vmap/compare/flip.h>
#include <vmap/error.h>

#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vmap {
namespace {

using Imath::V3d;

constexpr double color_power = 0.7;      // q_c of the paper
constexpr double knee_difference = 0.4;  // p_c
constexpr double knee_value = 0.95;      // p_t

/// Linear Rec.709 to XYZ under D65, in the exact fractions that the authors use.
V3d xyz_of(const V3d& rgb) {
    return {rgb.x * 10135552 / 24577794 + rgb.y * 8788810 / 24577794 + rgb.z * 4435075 / 24577794,
            rgb.x * 2613072 / 12288897 + rgb.y * 8788810 / 12288897 + rgb.z * 887015 / 12288897,
            rgb.x * 1425312 / 73733382 + rgb.y * 8788810 / 73733382 + rgb.z * 70074185 / 73733382};
}

const V3d& white() {
    static const V3d point = xyz_of(V3d(1, 1, 1));
    return point;
}

V3d rgb_of_xyz(const V3d& xyz) {
    static const Imath::M33d inverse = [] {
        const V3d r = xyz_of(V3d(1, 0, 0));
        const V3d g = xyz_of(V3d(0, 1, 0));
        const V3d b = xyz_of(V3d(0, 0, 1));
        return Imath::M33d(r.x, r.y, r.z, g.x, g.y, g.z, b.x, b.y, b.z).inverse();
    }();
    return xyz * inverse;
}

/// The opponent colours in which the eye's blur is linear.
V3d ycxcz_of(const V3d& rgb) {
    const V3d c = xyz_of(rgb) / white();
    return {116 * c.y - 16, 500 * (c.x - c.y), 200 * (c.y - c.z)};
}

V3d rgb_of_ycxcz(const V3d& color) {
    const double y = (color.x + 16) / 116;
    return rgb_of_xyz(V3d(color.y / 500 + y, y, y - color.z / 200) * white());
}

double lab_curve(double t) {
    constexpr double delta = 6.0 / 29;
    return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0 / 29;
}

/// CIE Lab whose colourfulness falls with lightness, as R. W. G. Hunt found.
V3d adjusted_lab(const V3d& rgb) {
    const V3d c = xyz_of(rgb) / white();
    const double lightness = 116 * lab_curve(c.y) - 16;
    return {lightness, 0.01 * lightness * 500 * (lab_curve(c.x) - lab_curve(c.y)),
            0.01 * lightness * 200 * (lab_curve(c.y) - lab_curve(c.z))};
}

/// Distance of colours that holds for large differences too.
double hyab(const V3d& a, const V3d& b) {
    return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

double largest_color_difference() {
    static const double value = std::pow(hyab(adjusted_lab(V3d(0, 1, 0)), adjusted_lab(V3d(0, 0, 1))), color_power);
    return value;
}

/// Compresses large differences: what is seen at once is not seen better when it grows.
double redistribute(double difference) {
    const double largest = largest_color_difference();
    const double knee = knee_difference * largest;
    if (difference < knee) return difference * knee_value / knee;
    return knee_value + (difference - knee) / (largest - knee) * (1 - knee_value);
}

/// What both pictures are turned into before they are compared.
struct Seen {
    std::vector<V3d> colors;  ///< adjusted Lab after the eye's blur
    Plane edges;
    Plane points;
};

Seen see(const std::vector<V3d>& rgb, int width, int height, double pixels_per_degree) {
    std::array<Plane, 3> opponent{Plane(width, height), Plane(width, height), Plane(width, height)};
    Plane achromatic(width, height);
    for (std::size_t i = 0; i < rgb.size(); ++i) {
        const V3d color = ycxcz_of(rgb[i]);
        for (int c = 0; c < 3; ++c) opponent[static_cast<std::size_t>(c)].values[i] = static_cast<float>(color[c]);
        achromatic.values[i] = static_cast<float>((color.x + 16) / 116);
    }
    const Plane y = seen_by_eye(opponent[0], EyeChannel::achromatic, pixels_per_degree);
    const Plane cx = seen_by_eye(opponent[1], EyeChannel::red_green, pixels_per_degree);
    const Plane cz = seen_by_eye(opponent[2], EyeChannel::blue_yellow, pixels_per_degree);
    Seen seen{.colors = std::vector<V3d>(rgb.size()),
              .edges = feature_strength(achromatic, Feature::edge, pixels_per_degree),
              .points = feature_strength(achromatic, Feature::point, pixels_per_degree)};
    for (std::size_t i = 0; i < rgb.size(); ++i) {
        V3d blurred = rgb_of_ycxcz(V3d(y.values[i], cx.values[i], cz.values[i]));
        for (int c = 0; c < 3; ++c) blurred[c] = std::clamp(blurred[c], 0.0, 1.0);
        seen.colors[i] = adjusted_lab(blurred);
    }
    return seen;
}

std::vector<float> flip_of_display(const std::vector<V3d>& test, const std::vector<V3d>& reference, int width,
                                   int height, double pixels_per_degree) {
    const Seen a = see(test, width, height, pixels_per_degree);
    const Seen b = see(reference, width, height, pixels_per_degree);
    std::vector<float> result(test.size());
    for (std::size_t i = 0; i < result.size(); ++i) {
        const double color = redistribute(std::pow(hyab(a.colors[i], b.colors[i]), color_power));
        const double feature = std::max(std::abs(a.edges.values[i] - b.edges.values[i]),
                                        std::abs(a.points.values[i] - b.points.values[i]));
        result[i] = static_cast<float>(std::pow(color, 1 - std::sqrt(feature / std::sqrt(2.0))));
    }
    return result;
}

/// K. Narkowicz' fit of the ACES curve, (k0 x^2 + k1 x) / (k3 x^2 + k4 x + k5), with its exposure of 0.6 inside.
struct ToneCurve {
    double k0 = 0.6 * 0.6 * 2.51;
    double k1 = 0.6 * 0.03;
    double k3 = 0.6 * 0.6 * 2.43;
    double k4 = 0.6 * 0.59;
    double k5 = 0.14;

    [[nodiscard]] double at(double x) const {
        return std::clamp((k0 * x * x + k1 * x) / (k3 * x * x + k4 * x + k5), 0.0, 1.0);
    }
    /// Where the curve reaches a value.
    [[nodiscard]] double inverse(double value) const {
        const double a = k0 - value * k3;
        const double half = (k1 - value * k4) / (2 * a);
        return -half + std::sqrt(half * half + value * k5 / a);
    }
};

/// From the exposure that brings the brightest pixel to 0.85 of white to the one that brings the median there.
std::vector<double> exposures_for(const Picture& reference) {
    std::vector<double> luminances;
    luminances.reserve(reference.pixels.size());
    for (const Imath::C3f& pixel : reference.pixels) luminances.push_back(xyz_of(V3d(pixel.x, pixel.y, pixel.z)).y);
    std::sort(luminances.begin(), luminances.end());
    const double brightest = luminances.back();
    if (!(brightest > 0)) return {0};
    const std::size_t half = luminances.size() / 2;
    const double median = luminances.size() % 2 == 1 ? luminances[half] : (luminances[half - 1] + luminances[half]) / 2;

    constexpr double most_stops = 20;  // a median of zero would ask for infinitely many
    const double start = std::log2(ToneCurve().inverse(0.85) / brightest);
    const double stops = std::min(most_stops, median > 0 ? std::log2(brightest / median) : most_stops);
    const int count = std::max(2, static_cast<int>(std::ceil(stops)));
    std::vector<double> exposures;
    exposures.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) exposures.push_back(start + stops * i / (count - 1));
    return exposures;
}

template <class F>
std::vector<V3d> display_values(const Picture& picture, const F& curve) {
    std::vector<V3d> values;
    values.reserve(picture.pixels.size());
    for (const Imath::C3f& pixel : picture.pixels) values.emplace_back(curve(pixel.x), curve(pixel.y), curve(pixel.z));
    return values;
}

}  // namespace

std::vector<float> flip_map(const Picture& test, const Picture& reference, FlipRange range, double pixels_per_degree) {
    if (test.width != reference.width || test.height != reference.height)
        throw UsageError(fmt::format("pictures of {} x {} and {} x {} pixels, expected the same size", test.width,
                                     test.height, reference.width, reference.height));
    if (reference.pixels.empty()) return {};
    const auto at_curve = [&](const auto& curve) {
        return flip_of_display(display_values(test, curve), display_values(reference, curve), test.width, test.height,
                               pixels_per_degree);
    };
    if (range == FlipRange::display) return at_curve([](double value) { return std::clamp(value, 0.0, 1.0); });

    std::vector<float> largest(reference.pixels.size(), 0.0F);
    for (const double exposure : exposures_for(reference)) {
        const ToneCurve tone;
        const std::vector<float> map =
            at_curve([&](double value) { return tone.at(std::max(0.0, value) * std::exp2(exposure)); });
        for (std::size_t i = 0; i < map.size(); ++i) largest[i] = std::max(largest[i], map[i]);
    }
    return largest;
}

}  // namespace vmap
