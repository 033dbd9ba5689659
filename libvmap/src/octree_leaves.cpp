// SPDX-License-Identifier: Apache-2.0
#include "octree_leaves.h"

#include "tree_leaves.h"

#include <tbb/parallel_for.h>

#include <vector>

namespace vmap {
namespace {

void split_into_sheets(const PointCloud& cloud, float rounding, Tree& tree) {
    const std::vector<std::uint32_t> cells = leaf_nodes_in_point_order(tree);
    std::vector<std::vector<std::uint32_t>> sheets(cells.size());
    tbb::parallel_for(std::size_t{0}, cells.size(), [&](std::size_t c) {
        const TreeNode& node = tree.nodes[cells[c]];
        sheets[c] =
            part_sheets(cloud, std::span(tree.point_order).subspan(node.first_point, node.point_count), rounding);
    });

    for (std::size_t c = 0; c < cells.size(); ++c) {
        if (sheets[c].size() == 1) continue;
        tree.nodes[cells[c]].first_child = static_cast<std::uint32_t>(tree.nodes.size());
        tree.nodes[cells[c]].child_count = static_cast<std::uint32_t>(sheets[c].size());
        std::uint32_t first = tree.nodes[cells[c]].first_point;
        for (const std::uint32_t count : sheets[c]) {
            TreeNode& sheet = tree.nodes.emplace_back();
            sheet.first_point = first;
            sheet.point_count = count;
            first += count;
        }
    }
}

}  // namespace

void finish_octree(const PointCloud& cloud, const OctreeGrid& grid, OctreeKind kind, Tree& tree) {
    split_into_sheets(cloud, grid.rounding, tree);
    complete_tree(cloud, tree);
    if (kind != OctreeKind::uniform) return;
    for (const TreeLeaf& leaf : tree.leaves)
        tree.cells.push_back(grid.cell(cloud.positions[tree.points_of(tree.nodes[leaf.node]).front()]));
}

}  // namespace vmap
