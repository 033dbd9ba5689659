// SPDX-License-Identifier: Apache-2.0
#include <vmap/leaf_ranges.h>

namespace vmap {

std::vector<LeafRange> leaf_ranges(const Tree& tree) {
    std::vector<LeafRange> ranges(tree.nodes.size());
    for (std::size_t n = tree.nodes.size(); n-- > 0;) {
        const TreeNode& node = tree.nodes[n];
        ranges[n] = node.is_leaf() ? LeafRange{node.leaf, node.leaf + 1}
                                   : LeafRange{ranges[node.first_child].begin,
                                               ranges[node.first_child + node.child_count - 1].end};
    }
    return ranges;
}

}  // namespace vmap
