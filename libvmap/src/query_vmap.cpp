// SPDX-License-Identifier: Apache-2.0
#include "query_engine.h"

#include <vmap/error.h>

#include <algorithm>
#include <cassert>
#include <string>

namespace vmap {
namespace {

using Imath::V3d;

constexpr std::size_t most_leaves = 1U << 18;

/// Squared distance of a place from a node's box.
double distance_squared(const TreeNode& node, const V3d& place) {
    V3d outside(0);
    for (int axis = 0; axis < 3; ++axis) {
        const auto low = static_cast<double>(node.bounds.min[axis]);
        const auto high = static_cast<double>(node.bounds.max[axis]);
        outside[axis] = std::max({low - place[axis], place[axis] - high, 0.0});
    }
    return outside.length2();
}

/// Calls visit(point, squared distance) for the points whose nodes come within `limit`, which visit may lower.
template <class Visit>
void visit_around(const QueryEngine& engine, const V3d& place, double& limit, const Visit& visit) {
    if (engine.tree.nodes.empty()) return;
    std::vector<std::uint32_t> open{0};
    while (!open.empty()) {
        const TreeNode& node = engine.tree.nodes[open.back()];
        open.pop_back();
        if (distance_squared(node, place) > limit) continue;
        if (node.is_leaf()) {
            for (const std::uint32_t i : engine.tree.points_of(node))
                visit(i, (V3d(engine.cloud.positions[i]) - place).length2());
            continue;
        }
        for (std::uint32_t c = 0; c < node.child_count; ++c) open.push_back(node.first_child + c);
        // The nearest child is opened first.
        const auto children = open.end() - node.child_count;
        std::sort(children, open.end(), [&](std::uint32_t a, std::uint32_t b) {
            return distance_squared(engine.tree.nodes[a], place) > distance_squared(engine.tree.nodes[b], place);
        });
    }
}

}  // namespace

std::vector<std::uint32_t> QueryEngine::leaves_of(std::span<const std::uint32_t> points) const {
    std::vector<std::uint32_t> leaves;
    for (const std::uint32_t point : points) leaves.push_back(leaf_of(point));
    std::ranges::sort(leaves);
    const auto rest = std::ranges::unique(leaves);
    leaves.erase(rest.begin(), rest.end());
    return leaves;
}

std::uint32_t QueryEngine::node_around(const std::vector<std::uint32_t>& leaves) const {
    const auto holds = [&](std::uint32_t n) {
        return ranges[n].holds(leaves.front()) && ranges[n].holds(leaves.back());
    };
    std::uint32_t n = 0;
    for (bool descends = true; descends;) {
        descends = false;
        for (std::uint32_t c = 0; c < tree.nodes[n].child_count && !descends; ++c) {
            if (!holds(tree.nodes[n].first_child + c)) continue;
            n = tree.nodes[n].first_child + c;
            descends = true;
        }
    }
    return n;
}

VmapQuery::VmapQuery(const PointCloud& cloud, const Tree& tree, const VisibilityMap& map, const PatchSet& patches) {
    if (tree.leaves.size() > most_leaves)
        throw UsageError("the tree has " + std::to_string(tree.leaves.size()) + " leaves; queries take at most " +
                         std::to_string(most_leaves));
    engine_ = map.rule == VisibilityRule::patch ? make_patch_engine(cloud, tree, map, patches)
                                                : make_centroid_engine(cloud, tree, map);
}

VmapQuery::~VmapQuery() = default;
VmapQuery::VmapQuery(VmapQuery&&) noexcept = default;
VmapQuery& VmapQuery::operator=(VmapQuery&&) noexcept = default;

bool VmapQuery::sees(std::uint32_t x, std::uint32_t y) const {
    return engine_->sees(x, y);
}

PairStatus VmapQuery::status(std::span<const std::uint32_t> xs, std::span<const std::uint32_t> ys,
                             QueryCost* cost) const {
    assert(!xs.empty() && !ys.empty());
    QueryCost own;
    return engine_->status(xs, ys, cost != nullptr ? *cost : own);
}

std::optional<PointHit> VmapQuery::first_point(const V3d& from, const V3d& direction) const {
    return engine_->first_point(from, direction);
}

PairStatus VmapQuery::light_status(std::uint32_t x, const LightSource& light) const {
    const PointCloud& cloud = engine_->cloud;
    const V3d position = cloud.origin + V3d(cloud.positions[x]);
    V3d to_light = light.position - position;
    if (light.kind == LightKind::sun) {
        // A place outside of the scene, on the way to the sun.
        const Imath::Box3f& bounds = engine_->tree.nodes[0].bounds;
        const double size = (V3d(bounds.max) - V3d(bounds.min)).length();
        to_light = light.direction * (-1.01 * std::max(size, 1e-30));
    }
    if (!(V3d(cloud.normals[x]).dot(to_light) > 0)) return PairStatus::invisible;
    if (light.kind == LightKind::spot && spot_falloff(light, -light.direction.dot(to_light.normalized())) <= 0)
        return PairStatus::invisible;
    return engine_->reaches(x, position + to_light) ? PairStatus::visible : PairStatus::invisible;
}

PairStatus VmapQuery::light_status(std::uint32_t x, std::span<const std::uint32_t> emitters, QueryCost* cost) const {
    assert(!emitters.empty());
    QueryCost own;
    return engine_->light_status(x, emitters, cost != nullptr ? *cost : own);
}

std::uint32_t VmapQuery::nearest_point(const V3d& place) const {
    std::uint32_t nearest = no_index;
    double limit = std::numeric_limits<double>::infinity();
    visit_around(*engine_, place - engine_->cloud.origin, limit, [&](std::uint32_t i, double squared) {
        if (squared > limit || (squared == limit && i > nearest)) return;
        limit = squared;
        nearest = i;
    });
    return nearest;
}

std::vector<std::uint32_t> VmapQuery::points_around(const V3d& place, double distance) const {
    std::vector<std::uint32_t> found;
    double limit = distance * distance;
    visit_around(*engine_, place - engine_->cloud.origin, limit, [&](std::uint32_t i, double squared) {
        if (squared <= limit) found.push_back(i);
    });
    std::ranges::sort(found);
    return found;
}

}  // namespace vmap
