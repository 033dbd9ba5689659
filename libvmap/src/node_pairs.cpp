// SPDX-License-Identifier: Apache-2.0
#include "node_pairs.h"

namespace vmap {

PairSplit::PairSplit(const Tree& tree) {
    size_.reserve(tree.nodes.size());
    for (const TreeNode& node : tree.nodes)
        size_.push_back(node.is_leaf() ? -1 : (Imath::V3d(node.bounds.max) - Imath::V3d(node.bounds.min)).length2());
}

std::vector<NodePair> sibling_pairs(const Tree& tree) {
    std::vector<NodePair> pairs;
    for (const TreeNode& node : tree.nodes)
        for (std::uint32_t i = 0; i < node.child_count; ++i)
            for (std::uint32_t j = i + 1; j < node.child_count; ++j)
                pairs.push_back({node.first_child + i, node.first_child + j});
    return pairs;
}

}  // namespace vmap
