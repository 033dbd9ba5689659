// SPDX-License-Identifier: Apache-2.0
/// \file
/// Bounds of the centroids and tangent planes under a node, in the coordinates of leaf_visibility.h, and what they say
/// about all pairs of leaves of two nodes at once.
#pragma once

#include <vmap/leaf_ranges.h>
#include <vmap/leaf_visibility.h>
#include <vmap/visibility_map.h>

#include <Imath/ImathBox.h>
#include <Imath/ImathVec.h>

#include <array>
#include <cmath>
#include <vector>

namespace vmap {

/// Where rounding could decide: nothing that holds by less is said of all leaves of a node.
inline constexpr float bounds_margin = 3e-6F;

/// A box that may be turned: center +- the three half axes.
struct TurnedBox {
    Imath::V3f center{0, 0, 0};
    std::array<Imath::V3f, 3> half_axes{Imath::V3f(0), Imath::V3f(0), Imath::V3f(0)};

    /// Half the extent along a direction.
    [[nodiscard]] float reach(const Imath::V3f& direction) const {
        return std::abs(direction.dot(half_axes[0])) + std::abs(direction.dot(half_axes[1])) +
               std::abs(direction.dot(half_axes[2]));
    }
};

struct NodeBounds {
    TurnedBox box;                   ///< of the centroids; in the frame of the plane when there is only one
    Imath::Box3f upright;            ///< the same along the axes
    Imath::Box3f normals;            ///< component by component
    float slab = 0;                  ///< largest of the planes
    float least_slab = 0;            ///< smallest of the planes
    std::uint32_t plane = no_index;  ///< the only plane under the node, or no_index
};

[[nodiscard]] std::vector<NodeBounds> bound_nodes(const LeafVisibility& leaves, const std::vector<LeafRange>& ranges);

/// How many pairs of leaves of two nodes face each other.
[[nodiscard]] Facing facing_of(const LeafVisibility& leaves, const NodeBounds& a, const NodeBounds& b);

}  // namespace vmap
