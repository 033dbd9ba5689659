// SPDX-License-Identifier: Apache-2.0
/// \file
/// The visibility map (V-map) of a tree: for every node the nodes that it sees completely.
///
/// This work is based on:
///   R. Goradia, A. Kanakanti, S. Chandran, A. Datta, "Visibility map for global illumination in point clouds",
///   GRAPHITE 2007.
#pragma once

#include <vmap/tree.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vmap {

/// What "leaf A sees leaf B" means; docs/vmap.md has both definitions.
enum class VisibilityRule : std::uint8_t {
    centroid,  ///< the seed's: the segment between the centroids is free of the tangent discs of all leaves
    patch      ///< the whole shaft between the two pieces of surface is free of every other patch
};

/// What one node sees of another.
enum class PairStatus : std::uint8_t {
    visible,    ///< completely: every leaf of one sees every leaf of the other
    invisible,  ///< completely: no leaf of one sees a leaf of the other
    partial     ///< neither
};

/// How many pairs of what two nodes hold (leaves or points) face each other.
enum class Facing : std::uint8_t { all, none, some };

/// Links between nodes of one tree. A link joins two nodes that see each other completely, at the highest level: each
/// pair of leaves that see each other is under exactly one link, and no other pair is under any. Where rule `patch`
/// stops early the first half holds for the pairs that it looked at.
struct VisibilityMap {
    VisibilityRule rule = VisibilityRule::centroid;
    std::vector<std::uint64_t> first_link;  ///< of each node in partners, and the end: nodes + 1
    std::vector<std::uint32_t> partners;    ///< nodes; every link stands here twice, once for either end

    /// Rule `patch` only, laid out like the links: pairs of nodes that see nothing of each other because patches lie
    /// between them, at the highest level. What is under neither a link nor one of these, and faces, is partial.
    std::vector<std::uint64_t> first_hidden;
    std::vector<std::uint32_t> hidden;

    /// The nodes that a node is linked with, ascending.
    [[nodiscard]] std::span<const std::uint32_t> links_of(std::uint32_t node) const {
        return std::span(partners).subspan(first_link[node], first_link[node + 1] - first_link[node]);
    }

    /// The nodes that are hidden from a node, ascending.
    [[nodiscard]] std::span<const std::uint32_t> hidden_from(std::uint32_t node) const {
        if (first_hidden.empty()) return {};
        return std::span(hidden).subspan(first_hidden[node], first_hidden[node + 1] - first_hidden[node]);
    }

    /// Links as ordered pairs, the way the seed counts them: twice the number of linked pairs.
    [[nodiscard]] std::size_t ordered_links() const { return partners.size(); }

    friend bool operator==(const VisibilityMap&, const VisibilityMap&) = default;
};

/// Whether two nodes are joined by a link of their own.
[[nodiscard]] bool has_link(const VisibilityMap& map, std::uint32_t a, std::uint32_t b);

/// Ordered pairs of leaves that see each other.
[[nodiscard]] std::uint64_t visible_leaf_pairs(const Tree& tree, const VisibilityMap& map);

}  // namespace vmap
