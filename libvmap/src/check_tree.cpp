// SPDX-License-Identifier: Apache-2.0
#include "check_tree.h"

#include <algorithm>
#include <vector>

namespace vmap {
namespace {

std::string at(const char* what, std::size_t index, const char* fault) {
    return std::string(what) + " " + std::to_string(index) + " " + fault;
}

/// Children come after their parent, each has one parent, and their points part its points.
std::string fault_of_children(const Tree& tree, std::size_t n, std::vector<char>& reached) {
    const TreeNode& node = tree.nodes[n];
    const std::size_t end = std::size_t{node.first_child} + node.child_count;
    if (node.first_child <= n || end > tree.nodes.size()) return at("node", n, "has children outside of the tree");
    std::uint64_t next_point = node.first_point;
    for (std::size_t c = node.first_child; c < end; ++c) {
        if (reached[c] != 0) return at("node", c, "has two parents");
        reached[c] = 1;
        if (tree.nodes[c].first_point != next_point) return at("node", c, "does not continue the points before it");
        next_point += tree.nodes[c].point_count;
    }
    if (next_point != std::uint64_t{node.first_point} + node.point_count)
        return at("node", n, "does not hold the points of its children");
    return {};
}

std::string fault_of_leaves(const Tree& tree) {
    std::uint64_t next_point = 0;
    for (std::size_t l = 0; l < tree.leaves.size(); ++l) {
        const std::uint32_t n = tree.leaves[l].node;
        if (n >= tree.nodes.size() || tree.nodes[n].leaf != l) return at("leaf", l, "is not that of its node");
        if (tree.nodes[n].first_point != next_point) return at("leaf", l, "is not in the order of the points");
        next_point += tree.nodes[n].point_count;
    }
    return {};
}

}  // namespace

std::string fault_of(const Tree& tree, std::size_t points) {
    if (tree.point_order.size() != points)
        return "the tree is of " + std::to_string(tree.point_order.size()) + " points, the cloud of " +
               std::to_string(points);
    if (tree.nodes.empty() != (points == 0)) return "the tree is empty, or the cloud is";
    if (tree.nodes.empty()) return tree.leaves.empty() ? "" : "leaves without a tree";
    if (tree.nodes[0].first_point != 0 || tree.nodes[0].point_count != points)
        return "the root does not hold all points";
    if (!tree.cells.empty() && tree.cells.size() != tree.leaves.size()) return "leaves without a cell";

    std::vector<char> seen(points);
    for (const std::uint32_t p : tree.point_order) {
        if (p >= points || seen[p] != 0) return "the order of the points does not name each once";
        seen[p] = 1;
    }
    std::vector<char> reached(tree.nodes.size());
    reached[0] = 1;
    for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
        const TreeNode& node = tree.nodes[n];
        if (reached[n] == 0) return at("node", n, "has no parent");
        if (node.point_count == 0) return at("node", n, "has no points");
        if (node.is_leaf() != (node.leaf < tree.leaves.size())) return at("node", n, "is neither leaf nor inner node");
        if (node.is_leaf()) continue;
        if (std::string fault = fault_of_children(tree, n, reached); !fault.empty()) return fault;
    }
    return fault_of_leaves(tree);
}

std::string fault_of(const VisibilityMap& map, const Tree& tree) {
    const std::size_t nodes = tree.nodes.size();
    if (map.first_link.size() != nodes + 1 || map.first_link.front() != 0 ||
        map.first_link.back() != map.partners.size() || !std::ranges::is_sorted(map.first_link))
        return "the links are not those of its nodes";
    for (std::uint32_t n = 0; n < nodes; ++n) {
        const auto links = map.links_of(n);
        if (!links.empty() && links.back() >= nodes) return at("node", n, "is linked with a node that is not there");
        if (std::ranges::adjacent_find(links, std::greater_equal{}) != links.end())
            return at("node", n, "has links out of order");
    }
    for (std::uint32_t n = 0; n < nodes; ++n)
        for (const std::uint32_t partner : map.links_of(n))
            if (partner == n || !has_link(map, partner, n)) return at("node", n, "has a link that its partner lacks");
    return {};
}

}  // namespace vmap
