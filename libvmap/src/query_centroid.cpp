// SPDX-License-Identifier: Apache-2.0
#include "leaf_pairs.h"
#include "query_engine.h"

#include <vmap/leaf_visibility.h>

#include <algorithm>
#include <cmath>

namespace vmap {
namespace {

using Imath::V3d;
using Imath::V3f;

class CentroidEngine final : public QueryEngine {
public:
    CentroidEngine(const PointCloud& points, const Tree& over_points, const VisibilityMap& map)
        : QueryEngine(points, over_points),
          pairs_(tree, ranges, map.first_link, map.partners),
          visibility_(tree),
          leaf_of_point_(points.size()) {
        for (std::uint32_t leaf = 0; leaf < tree.leaves.size(); ++leaf)
            for (const std::uint32_t point : tree.points_of(tree.nodes[tree.leaves[leaf].node]))
                leaf_of_point_[point] = leaf;
    }

    [[nodiscard]] bool sees(std::uint32_t x, std::uint32_t y) const override {
        return pairs_.has(leaf_of_point_[x], leaf_of_point_[y]);
    }

    [[nodiscard]] PairStatus status(std::span<const std::uint32_t> xs, std::span<const std::uint32_t> ys,
                                    QueryCost& cost) const override {
        const std::vector<std::uint32_t> from = leaves_of(xs);
        const std::vector<std::uint32_t> to = leaves_of(ys);
        // If the smallest nodes around both agree in all their leaves, one look is enough.
        ++cost.primitive_tests;
        const PairStatus whole = pairs_.status(ranges[node_around(from)], ranges[node_around(to)]);
        if (whole != PairStatus::partial) return whole;
        bool some = false;
        bool every = true;
        for (const std::uint32_t a : from)
            for (const std::uint32_t b : to) {
                ++cost.primitive_tests;
                const bool seen = pairs_.has(a, b);
                some |= seen;
                every &= seen;
                if (some && !every) return PairStatus::partial;
            }
        return every ? PairStatus::visible : PairStatus::invisible;
    }

    [[nodiscard]] std::optional<PointHit> first_point(const V3d& from, const V3d& direction) const override {
        const double unit = visibility_.unit_length();
        const double length = direction.length();
        if (tree.nodes.empty() || !(unit > 0) || !(length > 0) || !std::isfinite(length)) return std::nullopt;
        const V3d step = direction / length;
        // Start no farther off than needed, where floats still tell places apart.
        const V3d origin = from - cloud.origin;
        const V3d middle = V3d(tree.nodes[0].bounds.min) * 0.5 + V3d(tree.nodes[0].bounds.max) * 0.5;
        const double skipped = std::max(0.0, (middle - origin).dot(step) - 4 * unit);
        const std::optional<DiscHit> hit =
            visibility_.first_disc(visibility_.to_unit(origin + step * skipped), V3f(step));
        if (!hit) return std::nullopt;
        const double distance = skipped + static_cast<double>(hit->t) * unit;
        return PointHit{nearest_in_leaf(hit->leaf, V3f(origin + step * distance)), distance};
    }

    [[nodiscard]] bool reaches(std::uint32_t x, const V3d& place) const override {
        return !visibility_.is_blocked(visibility_.to_unit(V3d(cloud.positions[x])),
                                       visibility_.to_unit(place - cloud.origin));
    }

private:
    [[nodiscard]] std::uint32_t leaf_of(std::uint32_t point) const override { return leaf_of_point_[point]; }

    [[nodiscard]] std::uint32_t nearest_in_leaf(std::uint32_t leaf, const V3f& place) const {
        const auto points = tree.points_of(tree.nodes[tree.leaves[leaf].node]);
        return *std::ranges::min_element(
            points, {}, [&](std::uint32_t i) { return (V3d(cloud.positions[i]) - V3d(place)).length2(); });
    }

    LeafPairs pairs_;
    LeafVisibility visibility_;
    std::vector<std::uint32_t> leaf_of_point_;
};

}  // namespace

std::unique_ptr<const QueryEngine> make_centroid_engine(const PointCloud& cloud, const Tree& tree,
                                                        const VisibilityMap& map) {
    return std::make_unique<CentroidEngine>(cloud, tree, map);
}

}  // namespace vmap
