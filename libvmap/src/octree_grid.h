// SPDX-License-Identifier: Apache-2.0
/// \file
/// The cells of an octree and the key by which points are sorted into them.
#pragma once

#include <vmap/octree.h>

#include <Imath/ImathVec.h>

#include <cstdint>

namespace vmap {

/// A cube of 2^levels cells along each axis.
struct OctreeGrid {
    Imath::V3d corner{0, 0, 0};  ///< lowest corner, relative to the cloud's origin
    double cells_per_unit = 0;
    int levels = 0;
    float rounding =
        0;  ///< heights of flat points over their plane may differ by so much through rounding, world units

    [[nodiscard]] Imath::V3i cell(const Imath::V3f& position) const;

    /// Orientation class, then one octant per level from the coarsest: 3 * (levels + 1) bits.
    [[nodiscard]] std::uint64_t key(const Imath::V3f& position, const Imath::V3f& normal) const;
};

/// Grid for a cloud; checks the cloud and the config as build_octree documents.
[[nodiscard]] OctreeGrid make_octree_grid(const PointCloud& cloud, const OctreeConfig& config);

/// Longest edge of the box of the positions, world units; 0 for no points. Throws as build_octree does.
[[nodiscard]] double cloud_extent(const PointCloud& cloud);

}  // namespace vmap
