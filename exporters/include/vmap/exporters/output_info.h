// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What every output says about itself, and what all writers agree on.
#pragma once

#include <vmap/axes.h>
#include <vmap/light_units.h>
#include <vmap/point_cloud.h>

#include <cstddef>
#include <numbers>
#include <string>
#include <string_view>

namespace vmap {

/// Goes into the header of each file that a job writes.
struct OutputInfo {
    UpAxis up = UpAxis::y;  ///< axis that is up in the file
    LightUnits light_units = LightUnits::compat;
    double exposure = 1;  ///< display colours are sRGB of exposure x radiance
    std::string source;   ///< name of the file that the points came from
};

/// "y" or "z".
[[nodiscard]] std::string_view name_of(UpAxis up);

/// "compat", "spec" or "raw".
[[nodiscard]] std::string_view name_of(LightUnits units);

/// The name without control characters, on one line and of bounded length: fit for the header of a file.
[[nodiscard]] std::string header_text(std::string_view name);

/// Radiance that a point sends out: L = Le + albedo * E / pi, W/(m^2 sr). Irradiance that is missing counts as 0.
[[nodiscard]] Imath::C3f radiance_at(const LitCloud& cloud, std::size_t point);

/// Radius of the disc with the area that a point stands for, world units.
[[nodiscard]] float radius_at(const PointCloud& cloud, std::size_t point);

/// Mean distance between neighbouring points: root of the mean area, world units. Without areas it is estimated from
/// the bounding box; 0 for fewer than two points.
[[nodiscard]] double mean_spacing(const PointCloud& cloud);

/// World position to subtract from positions before they become floats: zero as long as floats keep a hundredth of the
/// spacing, else the cloud's origin.
[[nodiscard]] Imath::V3d output_offset(const PointCloud& cloud);

/// Exposure that shows a lit cloud well on a display: the brightest surfaces that do not emit come near to white. 1 for
/// a cloud without light.
[[nodiscard]] double automatic_exposure(const LitCloud& cloud);

}  // namespace vmap
