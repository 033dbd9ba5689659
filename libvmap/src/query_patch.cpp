// SPDX-License-Identifier: Apache-2.0
#include "leaf_pairs.h"
#include "patch_points.h"
#include "query_engine.h"

#include <vmap/patch_visibility.h>

#include <algorithm>
#include <cmath>

namespace vmap {
namespace {

using Imath::V2f;
using Imath::V3d;
using Imath::V3f;

class PatchEngine final : public QueryEngine {
public:
    PatchEngine(const PointCloud& points, const Tree& over_points, const VisibilityMap& map, const PatchSet& set)
        : QueryEngine(points, over_points),
          visibility_(points, over_points, set),
          visible_(tree, ranges, map.first_link, map.partners),
          hidden_(tree, ranges, map.first_hidden, map.hidden),
          patch_points_(points, set) {}

    [[nodiscard]] bool sees(std::uint32_t x, std::uint32_t y) const override {
        if (!visibility_.points_face(x, y)) return false;
        const std::uint32_t a = visibility_.site(x).leaf;
        const std::uint32_t b = visibility_.site(y).leaf;
        if (visible_.has(a, b)) return true;
        return !hidden_.has(a, b) && !visibility_.is_blocked(x, y);
    }

    /// Partial, too, when the map cannot tell: no point is tested.
    [[nodiscard]] PairStatus status(std::span<const std::uint32_t> xs, std::span<const std::uint32_t> ys,
                                    QueryCost& cost) const override {
        const std::vector<std::uint32_t> from = leaves_of(xs);
        const std::vector<std::uint32_t> to = leaves_of(ys);
        const std::uint32_t from_node = node_around(from);
        const std::uint32_t to_node = node_around(to);
        ++cost.primitive_tests;
        if (visible_.status(ranges[from_node], ranges[to_node]) == PairStatus::visible) return PairStatus::visible;
        if (hidden_.status(ranges[from_node], ranges[to_node]) == PairStatus::visible) return PairStatus::invisible;
        if (from_node != to_node && visibility_.facing(from_node, to_node) == Facing::none)
            return PairStatus::invisible;
        bool some = false;
        bool every = true;
        for (const std::uint32_t a : from)
            for (const std::uint32_t b : to) {
                ++cost.primitive_tests;
                const PairStatus one = leaf_status(a, b);
                some |= one != PairStatus::invisible;
                every &= one == PairStatus::visible;
                if (some && !every) return PairStatus::partial;
            }
        return every ? PairStatus::visible : PairStatus::invisible;
    }

    /// Points are tested only where the map cannot tell.
    [[nodiscard]] PairStatus light_status(std::uint32_t x, std::span<const std::uint32_t> emitters,
                                          QueryCost& cost) const override {
        const PairStatus whole = status({&x, 1}, emitters, cost);
        if (whole != PairStatus::partial) return whole;
        bool some = false;
        bool every = true;
        for (const std::uint32_t y : emitters) {
            ++cost.primitive_tests;
            const bool seen = sees(x, y);
            some |= seen;
            every &= seen;
            if (some && !every) return PairStatus::partial;
        }
        return every ? PairStatus::visible : PairStatus::invisible;
    }

    [[nodiscard]] std::optional<PointHit> first_point(const V3d& from, const V3d& direction) const override {
        const double length = direction.length();
        if (tree.nodes.empty() || !(length > 0) || !std::isfinite(length)) return std::nullopt;
        const V3d step = direction / length;
        const V3d origin = from - cloud.origin - visibility_.middle();
        // Start no farther off than needed, where floats still tell places apart.
        const double skipped = std::max(0.0, -origin.dot(step) - 2 * visibility_.half_diagonal());
        const V3d start = origin + step * skipped;
        const RayHit hit = visibility_.bvh().first_hit({V3f(start), V3f(step)});
        if (!hit) return std::nullopt;
        const V3d meets = start + step * static_cast<double>(hit.t) - visibility_.center(hit.polygon);
        const Patch& patch = visibility_.set().patches[hit.polygon];
        const V2f place(static_cast<float>(V3d(patch.u).dot(meets)), static_cast<float>(V3d(patch.v).dot(meets)));
        return PointHit{patch_points_.nearest(hit.polygon, place), skipped + static_cast<double>(hit.t)};
    }

    [[nodiscard]] bool reaches(std::uint32_t x, const V3d& place) const override {
        const V3f& from = visibility_.site(x).lifted;
        return !visibility_.bvh().any_hit({from, V3f(place - cloud.origin - visibility_.middle()) - from, 0, 1});
    }

private:
    [[nodiscard]] std::uint32_t leaf_of(std::uint32_t point) const override { return visibility_.site(point).leaf; }

    [[nodiscard]] PairStatus leaf_status(std::uint32_t a, std::uint32_t b) const {
        if (visible_.has(a, b)) return PairStatus::visible;
        if (hidden_.has(a, b)) return PairStatus::invisible;
        const bool averted = a != b && visibility_.facing(tree.leaves[a].node, tree.leaves[b].node) == Facing::none;
        return averted ? PairStatus::invisible : PairStatus::partial;
    }

    PatchVisibility visibility_;
    LeafPairs visible_;
    LeafPairs hidden_;
    PatchPoints patch_points_;
};

}  // namespace

std::unique_ptr<const QueryEngine> make_patch_engine(const PointCloud& cloud, const Tree& tree,
                                                     const VisibilityMap& map, const PatchSet& set) {
    return std::make_unique<PatchEngine>(cloud, tree, map, set);
}

}  // namespace vmap
