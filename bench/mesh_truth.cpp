// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh_truth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace vmap::bench {
namespace {

using Imath::V3f;

/// In spacings: clears the rounding of positions; and what a moved end must rise by to stay above a curved surface.
constexpr double lift = 0.01;
constexpr float moved_lift = 0.1F;

}  // namespace

MeshTruth::MeshTruth(const Room& room, std::vector<PointPair> pairs)
    : room_(room),
      triangles_(room, EmbreePeer::Of::truth),
      lifted_(lifted_points(room, lift)),
      pairs_(std::move(pairs)),
      seen_(pairs_.size()),
      near_(pairs_.size()) {
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
        seen_[i] = sees(pairs_[i]);
        near_[i] = is_near_silhouette(pairs_[i]);
    }
}

bool MeshTruth::sees(const PointPair& pair) const {
    return !triangles_.is_blocked(lifted_[pair.x], lifted_[pair.y]);
}

bool MeshTruth::is_near_silhouette(const PointPair& pair) const {
    const bool seen = sees(pair);
    const auto spacing = static_cast<float>(room_.spacing());
    const auto changes_around = [&](std::uint32_t moved, std::uint32_t still) {
        const V3f& n = room_.cloud.normals[moved];
        const V3f u = n.cross(std::abs(n.x) < 0.6F ? V3f(1, 0, 0) : V3f(0, 1, 0)).normalized();
        const V3f v = n.cross(u);
        return std::ranges::any_of(std::array{u, -u, v, -v}, [&](const V3f& way) {
            const V3f from = lifted_[moved] + (way + n * moved_lift) * spacing;
            return triangles_.is_blocked(from, lifted_[still]) == seen;
        });
    };
    return changes_around(pair.x, pair.y) || changes_around(pair.y, pair.x);
}

double MeshTruth::share_near_silhouettes() const {
    return static_cast<double>(std::ranges::count(near_, true)) / static_cast<double>(pairs_.size());
}

MeshTruth::Wrong MeshTruth::wrong(const std::function<bool(const PointPair&)>& sees) const {
    double all = 0;
    double away = 0;
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
        if (sees(pairs_[i]) == seen_[i]) continue;
        ++all;
        if (!near_[i]) ++away;
    }
    const auto count = static_cast<double>(pairs_.size());
    return {all / count, away / (count * (1 - share_near_silhouettes()))};
}

double broken_links(const MeshTruth& truth, const MappedRoom& mapped, std::size_t count) {
    if (mapped.map.partners.empty()) return 0;
    std::mt19937_64 random(3);
    const auto below = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
    const auto any_point = [&](std::size_t node) {
        const auto points = mapped.tree.points_of(mapped.tree.nodes[node]);
        return points[below(points.size())];
    };
    double broken = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t link = below(mapped.map.partners.size());
        const auto after = std::ranges::upper_bound(mapped.map.first_link, link);
        const auto node = static_cast<std::size_t>(after - mapped.map.first_link.begin()) - 1;
        if (!truth.sees({any_point(node), any_point(mapped.map.partners[link])})) ++broken;
    }
    return broken / static_cast<double>(count);
}

}  // namespace vmap::bench
