// SPDX-License-Identifier: Apache-2.0
/// \file
/// What every kind of tree needs once its nodes hold their points: leaves with centroid, averaged normal and R, bounds
/// and normal cones of all nodes.
#pragma once

#include <vmap/point_cloud.h>
#include <vmap/tree.h>

#include <cstdint>
#include <vector>

namespace vmap {

/// The nodes without children in the order of their points.
[[nodiscard]] std::vector<std::uint32_t> leaf_nodes_in_point_order(const Tree& tree);

/// Makes the leaves and fills in bounds and cones.
///
/// - tree: nodes with their children and points, children after their parents
void complete_tree(const PointCloud& cloud, Tree& tree);

}  // namespace vmap
