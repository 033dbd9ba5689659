// SPDX-License-Identifier: Apache-2.0
#include "cell_walk.h"
#include "leaf_planes.h"

#include <vmap/leaf_visibility.h>

#include <Imath/ImathBox.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace vmap {
namespace {

using Imath::V3d;
using Imath::V3f;
using Imath::V3i;

/// Half the thickness of a plane, as a share of the half diagonal: far above the rounding of floats in [-1, 1], far
/// below what anyone models.
constexpr double plane_eps = 8e-6;

/// Growth of spheres that makes up for rounding: no disc is missed that the exact test would find.
constexpr float sphere_growth = 1e-5F;

float squared_distance_to_segment(const V3f& place, const V3f& from, const V3f& to) {
    const V3f along = to - from;
    const float length_squared = along.length2();
    float t = length_squared > 0 ? (place - from).dot(along) / length_squared : 0.0F;
    t = std::clamp(t, 0.0F, 1.0F);
    return (from + along * t - place).length2();
}

std::uint32_t cell_key(const V3i& cell) {
    return static_cast<std::uint32_t>(cell.x << 20 | cell.y << 10 | cell.z);
}

}  // namespace

PlaneCoordinates to_plane(const LeafPlane& plane, const V3f& place) {
    // Not fused, here and below, so that every instruction set gives the same bits.
    const auto dot = [&](const V3f& axis, float start) {
        return axis.x * place.x + (axis.y * place.y + (axis.z * place.z + start));
    };
    return {dot(plane.u, 0), dot(plane.v, 0), dot(plane.normal, -plane.offset)};
}

bool crosses(const LeafPlane& plane, const LeafDisc& disc, const PlaneCoordinates& a, const PlaneCoordinates& b) {
    const bool downwards = a.height > plane.slab && b.height < -plane.slab;
    const bool upwards = a.height < -plane.slab && b.height > plane.slab;
    if (!downwards && !upwards) return false;
    const float t = a.height / (a.height - b.height);
    const float du = (t * (b.u - a.u) + a.u) - disc.u;
    const float dv = (t * (b.v - a.v) + a.v) - disc.v;
    return du * du + dv * dv < disc.radius_squared;
}

LeafVisibility::LeafVisibility(const Tree& tree) : tree_(tree) {
    if (tree.nodes.empty()) return;
    const Imath::Box3f& box = tree.nodes[0].bounds;
    const V3d size = V3d(box.max) - V3d(box.min);
    center_ = (V3d(box.max) + V3d(box.min)) / 2;
    unit_length_ = std::sqrt(size.length2()) / 2;
    // Places far from their origin are rounded more coarsely than the scene is large.
    const double largest = std::max({std::abs(center_.x), std::abs(center_.y), std::abs(center_.z)}) + unit_length_;
    const double rounding = 4 * double{std::numeric_limits<float>::epsilon()};
    eps_ = static_cast<float>(plane_eps + (unit_length_ > 0 ? rounding * largest / unit_length_ : 0));

    make_planes();
    make_spheres();
    if (walks_cells()) sort_cells();
}

V3f LeafVisibility::to_unit(const V3d& position) const {
    return unit_length_ > 0 ? V3f((position - center_) / unit_length_) : V3f(0);
}

void LeafVisibility::make_planes() {
    PlaneFinder finder(eps_);
    centroids_.reserve(tree_.leaves.size());
    discs_.reserve(tree_.leaves.size());
    const double scale = unit_length_ > 0 ? 1 / unit_length_ : 0;
    for (const TreeLeaf& leaf : tree_.leaves) {
        const V3f& centroid = centroids_.emplace_back(to_unit(V3d(leaf.centroid)));
        const auto thickness = static_cast<float>(static_cast<double>(leaf.thickness) * scale);
        const auto radius = static_cast<float>(static_cast<double>(leaf.radius) * scale);
        const bool flat = thickness <= 0.5F * eps_;
        discs_.push_back({flat ? finder.shared_plane(centroid, leaf.normal)
                               : finder.own_plane(centroid, leaf.normal, std::max(eps_, thickness)),
                          0, 0, radius * radius});
    }
    planes_ = finder.take();
    for (std::size_t leaf = 0; leaf < discs_.size(); ++leaf) {
        const PlaneCoordinates at = to_plane(planes_[discs_[leaf].plane], centroids_[leaf]);
        discs_[leaf].u = at.u;
        discs_[leaf].v = at.v;
    }
}

void LeafVisibility::make_spheres() {
    spheres_.resize(tree_.nodes.size());
    std::vector<Imath::Box3f> boxes(tree_.nodes.size());
    for (std::size_t n = tree_.nodes.size(); n-- > 0;) {
        const TreeNode& node = tree_.nodes[n];
        if (node.is_leaf()) {
            const float radius = std::sqrt(discs_[node.leaf].radius_squared) * (1 + sphere_growth) + sphere_growth;
            spheres_[n] = {centroids_[node.leaf], radius};
            boxes[n] = {centroids_[node.leaf] - V3f(radius), centroids_[node.leaf] + V3f(radius)};
            continue;
        }
        for (std::uint32_t c = 0; c < node.child_count; ++c) boxes[n].extendBy(boxes[node.first_child + c]);
        Sphere& sphere = spheres_[n];
        sphere.center = boxes[n].center();
        for (std::uint32_t c = 0; c < node.child_count; ++c) {
            const Sphere& child = spheres_[node.first_child + c];
            sphere.radius = std::max(sphere.radius, (child.center - sphere.center).length() + child.radius);
        }
        sphere.radius *= 1 + sphere_growth;
    }
}

void LeafVisibility::sort_cells() {
    cell_leaves_.resize(size());
    for (std::uint32_t leaf = 0; leaf < size(); ++leaf) cell_leaves_[leaf] = leaf;
    std::ranges::stable_sort(cell_leaves_, {}, [&](std::uint32_t leaf) { return cell_key(tree_.cells[leaf]); });
    for (std::uint32_t i = 0; i < size(); ++i) {
        auto& range = leaves_of_cell_.try_emplace(cell_key(tree_.cells[cell_leaves_[i]]), i, i).first->second;
        range.second = i + 1;
    }
}

bool LeafVisibility::face_each_other(std::uint32_t a, std::uint32_t b) const {
    const auto in_front = [&](std::uint32_t of, std::uint32_t leaf) {
        const LeafPlane& plane = planes_[discs_[of].plane];
        return to_plane(plane, centroids_[leaf]).height > plane.slab;
    };
    return in_front(a, b) && in_front(b, a);
}

bool LeafVisibility::blocks(std::uint32_t k, std::uint32_t a, std::uint32_t b) const {
    const LeafDisc& disc = discs_[k];
    const LeafPlane& plane = planes_[disc.plane];
    return crosses(plane, disc, to_plane(plane, centroids_[std::min(a, b)]),
                   to_plane(plane, centroids_[std::max(a, b)]));
}

bool LeafVisibility::may_block(std::uint32_t k, std::uint32_t a, std::uint32_t b) const {
    return !walks_cells() || CellWalk(tree_.cells[a], tree_.cells[b]).visits(tree_.cells[k]);
}

bool LeafVisibility::sees(std::uint32_t a, std::uint32_t b) const {
    if (!face_each_other(a, b)) return false;
    if (walks_cells()) return sees_through_cells(a, b);
    return !any_below(0, centroids_[a], centroids_[b], [&](std::uint32_t k) { return blocks(k, a, b); });
}

bool LeafVisibility::sees_through_cells(std::uint32_t a, std::uint32_t b) const {
    const CellWalk walk(tree_.cells[a], tree_.cells[b]);
    for (int step = 0; step <= walk.length(); ++step) {
        const auto found = leaves_of_cell_.find(cell_key(walk.cell(step)));
        if (found == leaves_of_cell_.end()) continue;
        for (std::uint32_t i = found->second.first; i < found->second.second; ++i)
            if (blocks(cell_leaves_[i], a, b)) return false;
    }
    return true;
}

/// The seed's ray-sphere traversal: an inner node whose sphere the segment meets is opened, a leaf is tested.
template <class Test>
bool LeafVisibility::any_below(std::uint32_t n, const V3f& from, const V3f& to, const Test& blocks_here) const {
    const Sphere& sphere = spheres_[n];
    if (squared_distance_to_segment(sphere.center, from, to) > sphere.radius * sphere.radius) return false;
    const TreeNode& node = tree_.nodes[n];
    if (node.is_leaf()) return blocks_here(node.leaf);
    for (std::uint32_t c = 0; c < node.child_count; ++c)
        if (any_below(node.first_child + c, from, to, blocks_here)) return true;
    return false;
}

bool LeafVisibility::is_blocked(const V3f& from, const V3f& to) const {
    if (tree_.nodes.empty()) return false;
    return any_below(0, from, to, [&](std::uint32_t k) {
        const LeafPlane& plane = planes_[discs_[k].plane];
        return crosses(plane, discs_[k], to_plane(plane, from), to_plane(plane, to));
    });
}

std::optional<DiscHit> LeafVisibility::first_disc(const V3f& from, const V3f& direction) const {
    if (tree_.nodes.empty()) return std::nullopt;
    // Nothing lies farther off than the far side of the whole scene's sphere.
    const float length = direction.length();
    const float reach = ((spheres_[0].center - from).length() + spheres_[0].radius) / length;
    std::optional<DiscHit> hit;
    float nearest = reach;
    std::vector<std::uint32_t> stack{0};
    while (!stack.empty()) {
        const std::uint32_t n = stack.back();
        stack.pop_back();
        const Sphere& sphere = spheres_[n];
        if (squared_distance_to_segment(sphere.center, from, from + direction * nearest) >
            sphere.radius * sphere.radius)
            continue;
        const TreeNode& node = tree_.nodes[n];
        if (!node.is_leaf()) {
            for (std::uint32_t c = node.child_count; c-- > 0;) stack.push_back(node.first_child + c);
            continue;
        }
        const LeafPlane& plane = planes_[discs_[node.leaf].plane];
        const PlaneCoordinates start = to_plane(plane, from);
        const PlaneCoordinates end = to_plane(plane, from + direction * reach);
        if (!crosses(plane, discs_[node.leaf], start, end)) continue;
        const float t = reach * start.height / (start.height - end.height);
        if (t > nearest || (t == nearest && hit && hit->leaf < node.leaf)) continue;
        nearest = t;
        hit = DiscHit{t, node.leaf};
    }
    return hit;
}

}  // namespace vmap
