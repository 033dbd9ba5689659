// SPDX-License-Identifier: Apache-2.0
/// \file
/// The one tree of the toolkit: a flat array of nodes over the points of a cloud. The V-map's links join its nodes,
/// occlusion walks it and light is exchanged over it. Octrees and the patch tree differ only in how they split.
#pragma once

#include <Imath/ImathBox.h>
#include <Imath/ImathVec.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace vmap {

/// "None" for 32-bit indices into nodes, leaves, patches and points.
inline constexpr std::uint32_t no_index = std::numeric_limits<std::uint32_t>::max();

/// A node has bounds only, for conservative tests; the averaged normal is a notion of leaves, as in the seed.
struct TreeNode {
    Imath::Box3f bounds;             ///< of its points, relative to the cloud's origin
    Imath::V3f cone_axis{0, 0, 1};   ///< unit; axis of a cone that holds every normal of the node
    float cone_cos = -1;             ///< cosine of the cone's half angle, to 1e-5; -1 when the normals go everywhere
    std::uint32_t first_child = 0;   ///< children are contiguous in Tree::nodes
    std::uint32_t child_count = 0;   ///< 0 for a leaf
    std::uint32_t first_point = 0;   ///< points are contiguous in Tree::point_order
    std::uint32_t point_count = 0;   ///< at least 1
    std::uint32_t leaf = no_index;   ///< index into Tree::leaves; no_index for an inner node
    std::uint32_t patch = no_index;  ///< the patch that the node is a part of; no_index above patches and in octrees

    [[nodiscard]] bool is_leaf() const { return child_count == 0; }

    friend bool operator==(const TreeNode&, const TreeNode&) = default;
};

/// The part of one surface in one cell: what links join and what a plain octree takes as an occluder.
struct TreeLeaf {
    Imath::V3f centroid{0, 0, 0};  ///< mean of its points, relative to the cloud's origin
    Imath::V3f normal{0, 0, 1};    ///< averaged normal of its points, unit
    float radius = 0;              ///< R of the seed: from the distribution of its points, world units
    float thickness = 0;           ///< largest distance of its points from its tangent plane, world units
    float area = 0;                ///< sum of its points' areas
    std::uint32_t node = 0;        ///< index into Tree::nodes

    friend bool operator==(const TreeLeaf&, const TreeLeaf&) = default;
};

/// Nodes in an order in which every child comes after its parent; nodes[0] is the root. Empty for an empty cloud.
/// Leaves are in the order of their points, so that every node's leaves are one range as well.
struct Tree {
    std::vector<TreeNode> nodes;
    std::vector<TreeLeaf> leaves;
    std::vector<std::uint32_t> point_order;  ///< indices into the cloud; every node's points are one range of it
    std::vector<Imath::V3i> cells;           ///< uniform octree only: each leaf's cell of the grid; else empty

    [[nodiscard]] std::span<const std::uint32_t> points_of(const TreeNode& node) const {
        return std::span(point_order).subspan(node.first_point, node.point_count);
    }

    friend bool operator==(const Tree&, const Tree&) = default;
};

}  // namespace vmap
