// SPDX-License-Identifier: Apache-2.0
#include <vmap/outline.h>
#include <vmap/patch_visibility.h>

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vmap {
namespace {

using Imath::V2d;
using Imath::V3d;
using Imath::V3f;

/// As shares of the half diagonal. A plane's thickness is far above the rounding of floats and far below what anyone
/// models; walls are left by a few of it.
constexpr double plane_eps = 8e-6;
constexpr double wall_lift = 4e-5;

/// In point spacings: what closes the cracks between the groups of a curved surface, and what leaves it.
constexpr double group_dilation = 0.15;
constexpr double group_lift = 0.35;

/// In eps: what stands less over a plane than facing_eps counts as lying in it. Whole nodes are called facing or
/// averted with a margin of one eps.
constexpr double facing_eps = 5;

/// The points of a flat patch may turn by so much from its normal, radians; cones above patches hold the points'
/// normals.
constexpr double flat_normal_range = 3e-3;
constexpr double cone_rounding = 3e-5;

/// Neighbours of a group lie about as far out of its plane as its own points do.
double lift_of_group(const PointCloud& cloud, const PatchSet& set, const Patch& patch) {
    double thickness = 0;
    for (const std::uint32_t i : set.points_of(patch))
        thickness = std::max(thickness, std::abs(V3d(patch.normal).dot(V3d(cloud.positions[i]) - V3d(patch.center))));
    return std::max(group_lift * static_cast<double>(patch.spacing()), thickness);
}

struct Range {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();
};

}  // namespace

PatchVisibility::PatchVisibility(const PointCloud& cloud, const Tree& tree, const PatchSet& set)
    : cloud_(cloud), tree_(tree), set_(set), sites_(cloud.size()) {
    if (tree.nodes.empty()) return;
    const Imath::Box3f& bounds = tree.nodes[0].bounds;
    middle_ = (V3d(bounds.max) + V3d(bounds.min)) / 2;
    half_diagonal_ = (V3d(bounds.max) - V3d(bounds.min)).length() / 2;
    double largest = 0;
    for (int axis = 0; axis < 3; ++axis)
        largest = std::max({largest, std::abs(static_cast<double>(bounds.min[axis])),
                            std::abs(static_cast<double>(bounds.max[axis]))});
    eps_ = plane_eps * half_diagonal_ + 4 * double{std::numeric_limits<float>::epsilon()} * largest;

    for (std::uint32_t p = 0; p < set.patches.size(); ++p) {
        centers_.push_back(V3d(set.patches[p].center) - middle_);
        normals_.emplace_back(set.patches[p].normal);
        offsets_.push_back(normals_[p].dot(centers_[p]));
        const double above = set.patches[p].flat ? 0 : lift_of_group(cloud, set, set.patches[p]);
        lift_.push_back(static_cast<float>(std::max({above, wall_lift * half_diagonal_, 5 * eps_})));
    }
    make_sites();
    grow_outlines();
    make_boxes();
}

void PatchVisibility::grow_outlines() {
    PolygonSet outlines;
    std::vector<V3f> polygon;
    first_vertex_.push_back(0);
    std::vector<V2d> flat;
    for (std::uint32_t p = 0; p < set_.patches.size(); ++p) {
        const Patch& patch = set_.patches[p];
        const double grown = patch.flat ? 0.25 * eps_ : group_dilation * static_cast<double>(patch.spacing());
        polygon.clear();
        const V3d& center = centers_[p];
        flat.clear();
        for (const V3f& v : set_.outlines[p]) {
            const V3d from_center = V3d(v) - V3d(patch.center);
            flat.emplace_back(from_center.dot(V3d(patch.u)), from_center.dot(V3d(patch.v)));
        }
        const std::vector<V2d> outline = offset_polygon(flat, grown);
        Imath::Box2d bounds;
        for (const V2d& q : outline) {
            vertices_.push_back(center + V3d(patch.u) * q.x + V3d(patch.v) * q.y);
            polygon.emplace_back(vertices_.back());
            bounds.extendBy(q);
        }
        outlines.add(polygon);
        for (std::size_t v = first_vertex_[p]; v < vertices_.size(); ++v) {
            const V3d& next = v + 1 < vertices_.size() ? vertices_[v + 1] : vertices_[first_vertex_[p]];
            const V3d inwards = normals_[p].cross((next - vertices_[v]).normalized());
            edges_.push_back({inwards, inwards.dot(vertices_[v])});
        }
        first_vertex_.push_back(vertices_.size());
        Disc& disc = discs_.emplace_back(Disc{bounds.center().x, bounds.center().y, 0});
        for (const V2d& q : outline) disc.radius = std::max(disc.radius, (q - bounds.center()).length());
    }
    bvh_ = PolygonBvh(outlines);
}

void PatchVisibility::make_boxes() {
    boxes_.resize(tree_.nodes.size());
    tbb::parallel_for(std::size_t{0}, boxes_.size(), [&](std::size_t n) {
        const TreeNode& node = tree_.nodes[n];
        if (node.patch == no_index) return;
        const Patch& patch = set_.patches[node.patch];
        FramedBox& box = boxes_[n];
        box.axes = {V3d(patch.u), V3d(patch.v), V3d(patch.normal)};
        Imath::Box3d bounds;
        for (const std::uint32_t i : tree_.points_of(node)) bounds.extendBy(box.coordinates(V3d(sites_[i].lifted)));
        const V3d middle = bounds.center();
        box.center = box.axes[0] * middle.x + box.axes[1] * middle.y + box.axes[2] * middle.z;
        box.half = bounds.size() / 2;
        if (patch.flat) box.half.z = 0;
        box.find_corners();
    });
    // Above patches a box holds the boxes of its children, whose corners may lie outside of all points.
    for (std::size_t n = boxes_.size(); n-- > 0;) {
        const TreeNode& node = tree_.nodes[n];
        if (node.patch != no_index) continue;
        Imath::Box3d bounds;
        for (std::uint32_t c = 0; c < node.child_count; ++c)
            for (const V3d& corner : boxes_[node.first_child + c].corners()) bounds.extendBy(corner);
        boxes_[n].center = bounds.center();
        boxes_[n].half = bounds.size() / 2;
        boxes_[n].find_corners();
    }
}

void PatchVisibility::make_sites() {
    tbb::parallel_for(std::size_t{0}, tree_.leaves.size(), [&](std::size_t leaf) {
        const TreeNode& node = tree_.nodes[tree_.leaves[leaf].node];
        const Patch& patch = set_.patches[node.patch];
        const V3d normal(patch.normal);
        for (const std::uint32_t i : tree_.points_of(node)) {
            const V3d place = V3d(cloud_.positions[i]) - middle_;
            // The points of a wall are taken to lie in it; those of a group are not left below its plane.
            double height = normal.dot(place - centers_[node.patch]);
            if (!patch.flat) height = std::min(height, 0.0);
            sites_[i].lifted = V3f(place + normal * (static_cast<double>(lift_[node.patch]) - height));
            sites_[i].normal = patch.flat ? patch.normal : cloud_.normals[i];
            sites_[i].leaf = static_cast<std::uint32_t>(leaf);
        }
    });
}

bool PatchVisibility::points_face(std::uint32_t x, std::uint32_t y) const {
    const Site& from = sites_[x];
    const Site& to = sites_[y];
    const V3d way = V3d(to.lifted) - V3d(from.lifted);
    const double least = facing_eps * eps_;
    return V3d(from.normal).dot(way) > least && -V3d(to.normal).dot(way) > least;
}

bool PatchVisibility::is_blocked(std::uint32_t x, std::uint32_t y) const {
    const V3f& from = sites_[std::min(x, y)].lifted;
    return bvh_.any_hit({from, sites_[std::max(x, y)].lifted - from, 0, 1});
}

bool PatchVisibility::sees(std::uint32_t x, std::uint32_t y) const {
    return points_face(x, y) && !is_blocked(x, y);
}

/// Whether the points of a node lie in front of those `of` another.
Facing PatchVisibility::in_front(std::uint32_t of, std::uint32_t node) const {
    const TreeNode& own = tree_.nodes[of];
    const FramedBox& base = boxes_[of];
    const bool is_wall = own.patch != no_index && set_.patches[own.patch].flat;
    Range range;
    if (is_wall) {
        for (const V3d& corner : boxes_[node].corners()) {
            const double height = base.coordinates(corner).z;
            range = {std::min(range.low, height - base.half.z), std::max(range.high, height + base.half.z)};
        }
    } else {
        // For a normal within the cone of half angle `wide`, along the way from the node's middle to a corner.
        const double wide = std::acos(std::clamp(static_cast<double>(own.cone_cos), -1.0, 1.0)) + cone_rounding +
                            (own.patch == no_index ? flat_normal_range : 0);
        if (wide >= 1.5) return Facing::some;
        // Within a patch the shaft's planes need every corner above the frame, too.
        if (own.patch != no_index)
            for (const V3d& corner : boxes_[node].corners())
                range.low = std::min(range.low, base.coordinates(corner).z - base.half.z);
        const double radius = base.half.length();
        const V3d axis(own.cone_axis);
        const double cosine = std::cos(wide);
        const double sine = std::sin(wide);
        for (const V3d& corner : boxes_[node].corners()) {
            const V3d way = corner - base.center;
            const double along = axis.dot(way);
            const double across = std::sqrt(std::max(0.0, way.length2() - along * along));
            range.low = std::min(range.low, along * cosine - across * sine - radius);
            // The normal that turns most towards the way, or the way itself when the cone holds it.
            const bool in_cone = across <= along * sine / cosine;
            range.high = std::max(range.high, (in_cone ? way.length() : along * cosine + across * sine) + radius);
        }
    }
    if (range.low > (facing_eps + 1) * eps_) return Facing::all;
    return range.high <= (facing_eps - 1) * eps_ ? Facing::none : Facing::some;
}

Facing PatchVisibility::facing(std::uint32_t a, std::uint32_t b) const {
    const Facing forth = in_front(a, b);
    if (forth == Facing::none) return Facing::none;
    const Facing back = in_front(b, a);
    if (back == Facing::none) return Facing::none;
    return forth == Facing::all && back == Facing::all ? Facing::all : Facing::some;
}

bool PatchVisibility::enters(std::uint32_t k, std::uint32_t a, std::uint32_t b, const PatchShaft& shaft) const {
    return shaft.is_entered(outline(k), eps_) && may_cross(k, a, b);
}

/// Whether a segment between two boxes may cross the disc around a patch. What a builder leaves out by the same tests
/// with more slack never enters a shaft.
bool PatchVisibility::may_cross(std::uint32_t k, std::uint32_t a, std::uint32_t b) const {
    Imath::Box3d around;
    for (const std::uint32_t node : {a, b})
        for (const V3d& corner : boxes_[node].corners()) around.extendBy(corner);
    around.min -= V3d(box_growth());
    around.max += V3d(box_growth());
    Imath::Box3d own;
    for (const V3d& v : outline(k)) own.extendBy(v);
    if (!around.intersects(own)) return false;

    const Patch& patch = set_.patches[k];
    const auto along = [&](std::uint32_t node, const V3f& axis) {
        const FramedBox& box = boxes_[node];
        const V3d direction(axis);
        const double middle = direction.dot(box.center - centers_[k]);
        double reach = 0;
        for (int i = 0; i < 3; ++i)
            reach += std::abs(direction.dot(box.axes.at(static_cast<std::size_t>(i)))) * (box.half[i] + box_growth());
        return Range{middle - reach, middle + reach};
    };
    const Range ha = along(a, patch.normal);
    const Range hb = along(b, patch.normal);
    const auto meets = [&](const Range& from, const Range& to) {  // heights on either side, counted positive
        if (!(from.high > eps_ && to.high > eps_)) return false;
        const double from_low = std::max(from.low, eps_);
        const double to_low = std::max(to.low, eps_);
        const std::array<double, 2> shares{from_low / (from_low + to.high), from.high / (from.high + to_low)};
        const auto distance = [&](const V3f& axis, double center) {
            const Range at_a = along(a, axis);
            const Range at_b = along(b, axis);
            Range range;
            for (const double t : shares) {
                range.low = std::min(range.low, at_a.low + t * (at_b.low - at_a.low));
                range.high = std::max(range.high, at_a.high + t * (at_b.high - at_a.high));
            }
            return std::max({range.low - center, center - range.high, 0.0});
        };
        const double du = distance(patch.u, discs_[k].u);
        const double dv = distance(patch.v, discs_[k].v);
        return du * du + dv * dv < discs_[k].radius * discs_[k].radius;
    };
    return meets(ha, {-hb.high, -hb.low}) || meets({-ha.high, -ha.low}, hb);
}

/// A segment crosses a plane at (f |t| + t |f|) / (|f| + |t|), f and t being the heights of its ends: inside of an edge
/// if the ends' distances from the edge weigh up to more than zero.
bool PatchVisibility::crosses_middle(std::uint32_t k, std::uint32_t a, std::uint32_t b) const {
    const V3d& from = boxes_[a].center;
    const V3d& to = boxes_[b].center;
    const double from_height = normals_[k].dot(from) - offsets_[k];
    const double to_height = normals_[k].dot(to) - offsets_[k];
    if (!(std::min(from_height, to_height) < -eps_ && std::max(from_height, to_height) > eps_)) return false;
    return std::ranges::all_of(edges(k), [&](const Edge& edge) {
        return (edge.inwards.dot(from) - edge.offset) * std::abs(to_height) +
                   (edge.inwards.dot(to) - edge.offset) * std::abs(from_height) >
               0;
    });
}

bool PatchVisibility::covers(std::uint32_t k, std::uint32_t a, std::uint32_t b) const {
    const auto from = boxes_[a].corners();
    const auto to = boxes_[b].corners();
    std::array<double, 8> from_height{};
    std::array<double, 8> to_height{};
    const auto see = [&](std::span<const V3d> corners, std::array<double, 8>& heights) {
        Range range;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            heights[i] = normals_[k].dot(corners[i]) - offsets_[k];
            range = {std::min(range.low, heights[i]), std::max(range.high, heights[i])};
            heights[i] = std::abs(heights[i]);
        }
        return range;
    };
    const Range at_from = see(from, from_height);
    const Range at_to = see(to, to_height);
    if (!(at_from.low > eps_ && at_to.high < -eps_) && !(at_from.high < -eps_ && at_to.low > eps_)) return false;

    for (const Edge& edge : edges(k))
        for (std::size_t i = 0; i < from.size(); ++i) {
            const double from_edge = edge.inwards.dot(from[i]) - edge.offset - eps_;
            for (std::size_t j = 0; j < to.size(); ++j) {
                const double to_edge = edge.inwards.dot(to[j]) - edge.offset - eps_;
                if (!(from_edge * to_height[j] + to_edge * from_height[i] > 0)) return false;
            }
        }
    return true;
}

}  // namespace vmap
