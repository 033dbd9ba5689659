// SPDX-License-Identifier: Apache-2.0
/// \file
/// From the cells of an octree to its leaves: sheets, centroid, averaged normal, R, bounds of every node.
#pragma once

#include "octree_grid.h"

namespace vmap {

/// Parts each cell that holds several parallel sheets into one child per sheet, makes the leaves and fills in the
/// bounds and normal cones.
///
/// - tree: nodes with their children and points, nothing else yet
void finish_octree(const PointCloud& cloud, const OctreeGrid& grid, OctreeKind kind, Tree& tree);

/// Reorders the points of one cell sheet by sheet, unless they are a single sheet. Two points next to each other in
/// height belong to different sheets when the gap between them is more than rounding, than the curvature of the cell's
/// normals and than the noise of its heights explain.
///
/// - points: indices into the cloud
/// - rounding: OctreeGrid::rounding
/// - returns the number of points of each sheet, lowest sheet first; one entry for a single sheet
[[nodiscard]] std::vector<std::uint32_t> part_sheets(const PointCloud& cloud, std::span<std::uint32_t> points,
                                                     float rounding);

}  // namespace vmap
