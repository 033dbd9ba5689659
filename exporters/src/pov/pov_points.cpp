// SPDX-License-Identifier: GPL-3.0-or-later
#include "../file_points.h"
#include "pov_frame.h"
#include "pov_setting.h"
#include "pov_text.h"

#include <vmap/error.h>
#include <vmap/exporters/camera_placement.h>
#include <vmap/exporters/pov_points.h>
#include <vmap/printable.h>
#include <vmap/version.h>

#include <cmath>
#include <numbers>
#include <string>

namespace vmap {
namespace {

using Imath::V3d;

bool is_finite(const V3d& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void write_head(PovText& text, const std::string& path, const LitCloud& cloud, const OutputInfo& info,
                const PovPointsConfig& config, const PovFrame& frame) {
    text.line("// {}", header_text(info.source));
    text.line("// Written by vmap {}: {} points. Run in this folder:", version, cloud.points.size());
    text.line("//   povray +I{} +O{} +FE +W{} +H{} +A0.1 +AM2 +R2 -D", pov_command_name(path), pov_picture_name(path),
              config.width, config.height);
    text.line("// Pixels are {}.",
              cloud.irradiance.empty() ? "albedo, linear Rec.709" : "radiance in W/(m^2 sr), linear Rec.709");
    text.line("//");
    write_conventions(text, info, frame);
    text.line("");
    text.line("#version 3.7;");
    text.line("global_settings {{ assumed_gamma 1 ambient_light 0 }}");
    text.line("#default {{ finish {{ ambient 0 diffuse 0 emission 1 specular 0 }} }}");
    text.line("");
}

/// Radius of points without an area, world units.
double fallback_radius(const PointCloud& cloud) {
    const double spacing = mean_spacing(cloud);
    return spacing > 0 ? spacing / std::sqrt(std::numbers::pi) : 0.5;
}

/// Writes points one by one.
class PointWriter {
public:
    PointWriter(PovText& text, const LitCloud& cloud, const PovPointsConfig& config, const PovFrame& frame)
        : text_(text), cloud_(cloud), config_(config), frame_(frame), fallback_(fallback_radius(cloud.points)) {}

    void write(std::size_t i) {
        const PointCloud& points = cloud_.points;
        const V3d position = (points.origin + V3d(points.positions[i])) * frame_.frame_from_world;
        const double own_radius = radius_at(points, i);
        const double radius = (own_radius > 0 ? own_radius : fallback_) * config_.radius_scale * frame_.scale;
        V3d normal(0);
        if (!points.normals.empty()) frame_.frame_from_world.multDirMatrix(V3d(points.normals[i]), normal);
        normal.normalize();

        const Imath::C3f color = display_color(cloud_, i, 1);
        if (config_.shape == PovPointShape::discs && is_finite(normal) && normal.length2() > 0) {
            const V3d raised = position + normal * (radius * raised_share);
            text_.line(
                "disc{{<{:.9g},{:.9g},{:.9g}>,<{:.5g},{:.5g},{:.5g}>,{:.5g} pigment{{rgb<{:.6g},{:.6g},{:.6g}>}}}}",
                raised.x, raised.y, raised.z, normal.x, normal.y, normal.z, radius, color.x, color.y, color.z);
        } else {
            text_.line("sphere{{<{:.9g},{:.9g},{:.9g}>,{:.5g} pigment{{rgb<{:.6g},{:.6g},{:.6g}>}}}}", position.x,
                       position.y, position.z, radius, color.x, color.y, color.z);
        }
    }

private:
    static constexpr double raised_share = 1e-3;
    PovText& text_;
    const LitCloud& cloud_;
    const PovPointsConfig& config_;
    const PovFrame& frame_;
    double fallback_;
};

void check(const LitCloud& cloud, const PovPointsConfig& config, const std::string& path) {
    if (!(config.radius_scale > 0) || !std::isfinite(config.radius_scale))
        throw UsageError(
            fmt::format("{}: radius scale {}, expected a positive number", printable(path), config.radius_scale));
    if (config.width < 1 || config.height < 1)
        throw UsageError(fmt::format("{}: a picture of {} x {} pixels, expected at least 1 x 1", printable(path),
                                     config.width, config.height));
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
        if (!is_finite(V3d(cloud.points.positions[i])) || !is_finite(V3d(display_color(cloud, i, 1))))
            throw UnsupportedInput(fmt::format("{}: point {} has a number that is not finite", printable(path), i));
    }
}

}  // namespace

void write_pov_points(FileWriter& file, const LitCloud& cloud, const OutputInfo& info, const PovPointsConfig& config,
                      const ProgressCallback& progress) {
    check(cloud, config, file.path());
    const Imath::Box3d bounds = bounds_of(cloud.points);
    const PovFrame frame(bounds, info.up);
    const double aspect = static_cast<double>(config.width) / config.height;

    PovText text(file);
    write_head(text, file.path(), cloud, info, config, frame);
    text.line("{}", pov_camera(config.camera ? *config.camera : place_camera(bounds, aspect), frame));
    const std::size_t count = cloud.points.size();
    PointWriter points(text, cloud, config, frame);
    if (count > 0) text.line("union {{");
    for (std::size_t i = 0; i < count; ++i) {
        points.write(i);
        constexpr std::size_t step = 65536;
        if (i % step == 0) report_progress(progress, "write", static_cast<double>(i) / static_cast<double>(count));
    }
    // An interior texture asks for an exterior one; each point has its own.
    if (count > 0) text.line("texture {{ pigment {{ rgb 0 }} }} interior_texture {{ pigment {{ rgb 0 }} }} }}");
    text.flush();
    report_progress(progress, "write", 1);
}

}  // namespace vmap
