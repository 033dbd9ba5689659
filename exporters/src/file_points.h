// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The points of a cloud in the axes of a file and relative to the file's offset: the same for all formats.
#pragma once

#include <vmap/exporters/output_info.h>

#include <cstddef>

namespace vmap {

/// Keeps references to the cloud, which must outlive it.
class FilePoints {
public:
    FilePoints(const PointCloud& cloud, UpAxis up)
        : cloud_(cloud),
          up_(up),
          world_offset_(output_offset(cloud)),
          shift_(cloud.origin - world_offset_),
          shifted_(shift_ != Imath::V3d(0, 0, 0)) {}

    /// To be added to position(), in the axes of the file.
    [[nodiscard]] Imath::V3d offset() const {
        return file_from_world(up_, world_offset_) + Imath::V3d(0, 0, 0);  // turns -0 into 0
    }

    [[nodiscard]] Imath::V3f position(std::size_t i) const {
        const Imath::V3f& position = cloud_.positions[i];
        return file_from_world(up_, shifted_ ? Imath::V3f(Imath::V3d(position) + shift_) : position);
    }

    /// Zero where the cloud has no normals.
    [[nodiscard]] Imath::V3f normal(std::size_t i) const {
        return cloud_.normals.empty() ? Imath::V3f(0, 0, 0) : file_from_world(up_, cloud_.normals[i]);
    }

private:
    const PointCloud& cloud_;
    UpAxis up_;
    Imath::V3d world_offset_;
    Imath::V3d shift_;  ///< from the cloud's origin to the file's
    bool shifted_;
};

/// What a viewer shows of a point, linear: exposure x radiance, not clamped; the albedo of a cloud that is not lit.
[[nodiscard]] inline Imath::C3f display_color(const LitCloud& cloud, std::size_t i, double exposure) {
    if (!cloud.irradiance.empty()) return radiance_at(cloud, i) * static_cast<float>(exposure);
    return cloud.points.albedo.empty() ? Imath::C3f(0, 0, 0) : cloud.points.albedo[i];
}

}  // namespace vmap
