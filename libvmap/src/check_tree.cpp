// SPDX-License-Identifier: Apache-2.0
#include "check_tree.h"

#include <algorithm>
#include <functional>
#include <span>
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

/// Both directions of pairs of nodes, as in VisibilityMap.
std::string fault_of_pairs(std::span<const std::uint64_t> first, std::span<const std::uint32_t> partners,
                           std::size_t nodes) {
    if (first.size() != nodes + 1 || first.front() != 0 || first.back() != partners.size() ||
        !std::ranges::is_sorted(first))
        return "the links are not those of its nodes";
    const auto links_of = [&](std::size_t n) { return partners.subspan(first[n], first[n + 1] - first[n]); };
    for (std::uint32_t n = 0; n < nodes; ++n) {
        const auto links = links_of(n);
        if (!links.empty() && links.back() >= nodes) return at("node", n, "is linked with a node that is not there");
        if (std::ranges::adjacent_find(links, std::greater_equal{}) != links.end())
            return at("node", n, "has links out of order");
    }
    for (std::uint32_t n = 0; n < nodes; ++n)
        for (const std::uint32_t partner : links_of(n))
            if (partner == n || !std::ranges::binary_search(links_of(partner), n))
                return at("node", n, "has a link that its partner lacks");
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
    std::string fault = fault_of_pairs(map.first_link, map.partners, nodes);
    if (fault.empty() && (map.rule == VisibilityRule::patch || !map.first_hidden.empty()))
        fault = fault_of_pairs(map.first_hidden, map.hidden, nodes);
    return fault;
}

std::string fault_of(const PatchSet& set, const Tree& tree) {
    for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
        const TreeNode& node = tree.nodes[n];
        if (node.patch == no_index) {
            if (node.is_leaf()) return at("leaf", node.leaf, "belongs to no patch");
            continue;
        }
        if (node.patch >= set.patches.size()) return at("node", n, "belongs to a patch that is not there");
        const Patch& patch = set.patches[node.patch];
        if (node.first_point < patch.first_point ||
            std::uint64_t{node.first_point} + node.point_count > std::uint64_t{patch.first_point} + patch.point_count)
            return at("node", n, "is not a part of its patch");
        for (std::uint32_t c = 0; c < node.child_count; ++c)
            if (tree.nodes[node.first_child + c].patch != node.patch)
                return at("node", n, "has a child of another patch");
    }
    std::uint64_t points = 0;
    for (std::size_t p = 0; p < set.patches.size(); ++p) {
        const Patch& patch = set.patches[p];
        if (std::uint64_t{patch.first_point} + patch.point_count > tree.point_order.size() || patch.point_count == 0)
            return at("patch", p, "has points that are not there");
        if (!(patch.area >= 0)) return at("patch", p, "has no area");
        points += patch.point_count;
    }
    return points == tree.point_order.size() ? "" : "the patches do not hold all points";
}

}  // namespace vmap
