// SPDX-License-Identifier: Apache-2.0
/// \file
/// The point of a patch that is nearest to a place in its plane.
#pragma once

#include <vmap/patch.h>
#include <vmap/point_cloud.h>

#include <Imath/ImathVec.h>

#include <cstdint>
#include <vector>

namespace vmap {

/// A grid over every patch.
class PatchPoints {
public:
    PatchPoints(const PointCloud& cloud, const PatchSet& set);

    /// - place: in the coordinates of the patch's plane
    /// - returns an index into the cloud
    [[nodiscard]] std::uint32_t nearest(std::uint32_t patch, const Imath::V2f& place) const;

private:
    struct Grid {
        Imath::V2f corner{0, 0};
        float per_unit = 0;
        std::uint32_t columns = 1;
        std::uint32_t rows = 1;
        std::size_t first_cell = 0;  ///< in first_entry_
    };

    struct Entry {
        Imath::V2f place;
        std::uint32_t point = 0;
    };

    std::vector<Grid> grids_;
    std::vector<std::uint32_t> first_entry_;  ///< of each cell, grid after grid, each with an end
    std::vector<Entry> entries_;
};

}  // namespace vmap
