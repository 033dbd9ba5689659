// SPDX-License-Identifier: Apache-2.0
#include "node_bounds.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace vmap {
namespace {

using Imath::V3f;

/// Box of a flat node's centroids along the axes of its plane.
TurnedBox box_in_plane(const LeafPlane& plane, std::span<const V3f> centroids) {
    Imath::Box3f box;
    for (const V3f& c : centroids) box.extendBy(V3f(plane.u.dot(c), plane.v.dot(c), plane.normal.dot(c)));
    const V3f middle = box.center();
    const V3f half = box.size() / 2;
    return {plane.u * middle.x + plane.v * middle.y + plane.normal * middle.z,
            {plane.u * half.x, plane.v * half.y, plane.normal * half.z}};
}

TurnedBox upright_box(const Imath::Box3f& box) {
    const V3f half = box.size() / 2;
    return {box.center(), {V3f(half.x, 0, 0), V3f(0, half.y, 0), V3f(0, 0, half.z)}};
}

/// Whether the leaves of b lie in front of the planes of a.
Facing in_front(const LeafVisibility& leaves, const NodeBounds& a, const NodeBounds& b) {
    float low = 0;
    float high = 0;
    if (a.plane != no_index) {
        const LeafPlane& plane = leaves.planes()[a.plane];
        const float middle = plane.normal.dot(b.box.center) - plane.offset;
        const float reach = b.box.reach(plane.normal);
        low = middle - reach;
        high = middle + reach;
    } else {
        for (int axis = 0; axis < 3; ++axis) {  // intervals of a normal times a way from a to b
            const float from = b.upright.min[axis] - a.upright.max[axis];
            const float to = b.upright.max[axis] - a.upright.min[axis];
            const std::array<float, 4> ends{a.normals.min[axis] * from, a.normals.min[axis] * to,
                                            a.normals.max[axis] * from, a.normals.max[axis] * to};
            low += *std::ranges::min_element(ends);
            high += *std::ranges::max_element(ends);
        }
    }
    if (low > a.slab + bounds_margin) return Facing::all;
    return high <= a.least_slab - bounds_margin ? Facing::none : Facing::some;
}

}  // namespace

std::vector<NodeBounds> bound_nodes(const LeafVisibility& leaves, const std::vector<LeafRange>& ranges) {
    const Tree& tree = leaves.tree();
    std::vector<NodeBounds> bounds(tree.nodes.size());
    for (std::size_t n = tree.nodes.size(); n-- > 0;) {
        const TreeNode& node = tree.nodes[n];
        NodeBounds& own = bounds[n];
        if (node.is_leaf()) {
            const V3f& centroid = leaves.centroids()[node.leaf];
            own.plane = leaves.discs()[node.leaf].plane;
            const LeafPlane& plane = leaves.planes()[own.plane];
            own.upright = Imath::Box3f(centroid);
            own.normals = Imath::Box3f(plane.normal);
            own.slab = plane.slab;
            own.least_slab = plane.slab;
            continue;
        }
        own.plane = bounds[node.first_child].plane;
        own.least_slab = bounds[node.first_child].least_slab;
        for (std::uint32_t c = 0; c < node.child_count; ++c) {
            const NodeBounds& child = bounds[node.first_child + c];
            own.upright.extendBy(child.upright);
            own.normals.extendBy(child.normals);
            own.slab = std::max(own.slab, child.slab);
            own.least_slab = std::min(own.least_slab, child.least_slab);
            if (child.plane != own.plane) own.plane = no_index;
        }
    }
    tbb::parallel_for(std::size_t{0}, bounds.size(), [&](std::size_t n) {
        NodeBounds& own = bounds[n];
        own.box = own.plane == no_index ? upright_box(own.upright)
                                        : box_in_plane(leaves.planes()[own.plane],
                                                       leaves.centroids().subspan(ranges[n].begin, ranges[n].size()));
    });
    return bounds;
}

Facing facing_of(const LeafVisibility& leaves, const NodeBounds& a, const NodeBounds& b) {
    const Facing forth = in_front(leaves, a, b);
    if (forth == Facing::none) return Facing::none;
    const Facing back = in_front(leaves, b, a);
    if (back == Facing::none) return Facing::none;
    return forth == Facing::all && back == Facing::all ? Facing::all : Facing::some;
}

}  // namespace vmap
