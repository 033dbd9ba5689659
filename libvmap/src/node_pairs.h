// SPDX-License-Identifier: Apache-2.0
/// \file
/// The order in which all builders go through pairs of nodes. It is a part of what the V-map is: links can only join
/// pairs that this order comes by.
///
/// Every pair of leaves lies under one pair of siblings. From there on the pair's larger node is split until both are
/// leaves. In a pair the node that comes first in the order of the points is named first.
#pragma once

#include <vmap/tree.h>

#include <cstdint>
#include <vector>

namespace vmap {

struct NodePair {
    std::uint32_t first = 0;
    std::uint32_t second = 0;

    friend bool operator==(const NodePair&, const NodePair&) = default;
};

class PairSplit {
public:
    explicit PairSplit(const Tree& tree);

    /// Whether a pair is split at its first node: the larger of the two by the diagonal of its bounds, the first of two
    /// equal ones; a leaf never. At most one of the pair may be a leaf.
    [[nodiscard]] bool splits_first(const NodePair& pair) const {
        return size_[pair.second] < 0 || size_[pair.first] >= size_[pair.second];
    }

    /// Whether both are leaves.
    [[nodiscard]] bool is_done(const NodePair& pair) const { return size_[pair.first] < 0 && size_[pair.second] < 0; }

    /// Calls visit(part) for every pair that a pair is split into, in order.
    template <class Visit>
    void for_each_part(const Tree& tree, const NodePair& pair, const Visit& visit) const {
        const bool at_first = splits_first(pair);
        const TreeNode& node = tree.nodes[at_first ? pair.first : pair.second];
        for (std::uint32_t c = 0; c < node.child_count; ++c) {
            const std::uint32_t child = node.first_child + c;
            visit(at_first ? NodePair{child, pair.second} : NodePair{pair.first, child});
        }
    }

private:
    std::vector<double> size_;  ///< squared diagonal; -1 for leaves
};

/// All pairs of siblings.
[[nodiscard]] std::vector<NodePair> sibling_pairs(const Tree& tree);

}  // namespace vmap
