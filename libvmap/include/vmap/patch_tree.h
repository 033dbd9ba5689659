// SPDX-License-Identifier: Apache-2.0
/// \file
/// The tree over patches: its upper part joins patches by orientation and place, its lower part cuts each patch into
/// cells of the patch's own plane. A leaf is the part of one patch in one cell.
#pragma once

#include <vmap/patch.h>
#include <vmap/point_cloud.h>
#include <vmap/tree.h>

#include <cstddef>
#include <cstdint>

namespace vmap {

struct PatchTreeConfig {
    double cell_size = 0;               ///< a cell is halved along a side that is longer, world units; 0: no limit
    std::uint32_t points_per_leaf = 0;  ///< and while it holds more points; 0: no limit
};

/// Cuts every patch into cells. Every point is in exactly one leaf, every leaf in one patch (TreeNode::patch), no node
/// has a single child. The same bit for bit at any number of threads.
///
/// - set: of this cloud; the points of its patches are put into the tree's order
/// - throws UsageError for a negative cell size
[[nodiscard]] Tree build_patch_tree(const PointCloud& cloud, PatchSet& set, const PatchTreeConfig& config = {});

/// The cell size with which a patch tree comes closest to a wanted number of leaves.
[[nodiscard]] PatchTreeConfig patch_tree_config_for_leaves(const PointCloud& cloud, const PatchSet& set,
                                                           std::size_t leaves);

}  // namespace vmap
