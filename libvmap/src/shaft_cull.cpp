// SPDX-License-Identifier: Apache-2.0
#include "shaft_cull.h"

#include <algorithm>
#include <cmath>

namespace vmap {
namespace {

struct Interval {
    float low = 0;
    float high = 0;
};

Interval along(const TurnedBox& box, const Imath::V3f& direction, float start) {
    const float middle = direction.dot(box.center) + start;
    const float reach = box.reach(direction);
    return {middle - reach, middle + reach};
}

/// Range of (1 - t) * a + t * b.
Interval mix(const Interval& a, const Interval& b, const Interval& t) {
    const auto at = [](float from, float to, float share) { return from + share * (to - from); };
    return {std::min(at(a.low, b.low, t.low), at(a.low, b.low, t.high)) - bounds_margin,
            std::max(at(a.high, b.high, t.low), at(a.high, b.high, t.high)) + bounds_margin};
}

enum class Effect { none, some, all };

/// What a wall does to the segments that go from heights `ha` on one side of its plane to heights `hb` on the other
/// side, both counted positive.
Effect effect_through(const WallOccluder& wall, const TurnedBox& a, const TurnedBox& b, const Interval& ha,
                      const Interval& hb) {
    const Interval t{ha.low / (ha.low + hb.high), ha.high / (ha.high + hb.low)};
    const LeafPlane& plane = wall.plane;
    const Interval u = mix(along(a, plane.u, 0), along(b, plane.u, 0), t);
    if (u.high < wall.bounds.u_min || u.low > wall.bounds.u_max) return Effect::none;
    const Interval v = mix(along(a, plane.v, 0), along(b, plane.v, 0), t);
    if (v.high < wall.bounds.v_min || v.low > wall.bounds.v_max) return Effect::none;
    switch (wall.raster.look_up({u.low, u.high, v.low, v.high})) {
        case PlaneRaster::Cell::empty:
            return Effect::none;
        case PlaneRaster::Cell::covered:
            return Effect::all;
        case PlaneRaster::Cell::mixed:
            break;
    }
    return Effect::some;
}

Effect effect_of(const WallOccluder& wall, const TurnedBox& a, const TurnedBox& b) {
    const LeafPlane& plane = wall.plane;
    const Interval ha = along(a, plane.normal, -plane.offset);
    const Interval hb = along(b, plane.normal, -plane.offset);
    const float least = plane.slab - bounds_margin;
    const bool downwards = ha.high > least && hb.low < -least;
    const bool upwards = ha.low < -least && hb.high > least;
    if (!downwards && !upwards) return Effect::none;
    Effect effect = Effect::none;
    if (downwards)
        effect = effect_through(wall, a, b, {std::max(ha.low, least), ha.high}, {std::max(-hb.high, least), -hb.low});
    if (upwards && effect == Effect::none)
        effect = effect_through(wall, a, b, {std::max(-ha.high, least), -ha.low}, {std::max(hb.low, least), hb.high});
    if (effect != Effect::all) return effect;
    // All that cross are blocked; do all cross?
    const float sure = plane.slab + bounds_margin;
    const bool all_cross = (ha.low > sure && hb.high < -sure) || (ha.high < -sure && hb.low > sure);
    return all_cross ? Effect::all : Effect::some;
}

}  // namespace

bool cull_walls(std::span<const WallOccluder> walls, std::span<const std::uint32_t> list, const TurnedBox& a,
                const TurnedBox& b, std::vector<std::uint32_t>& left) {
    for (const std::uint32_t w : list) {
        const Effect effect = effect_of(walls[w], a, b);
        if (effect == Effect::all) return true;
        if (effect != Effect::none) left.push_back(w);
    }
    return false;
}

}  // namespace vmap
