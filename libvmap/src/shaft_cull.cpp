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

/// What an occluder does to the segments that go from heights `ha` on one side of its plane to heights `hb` on the other
/// side, both counted positive.
Effect effect_through(const Occluder& occluder, const Occluders& occluders, const TurnedBox& a, const TurnedBox& b,
                      const Interval& ha, const Interval& hb) {
    const Interval t{ha.low / (ha.low + hb.high), ha.high / (ha.high + hb.low)};
    const LeafPlane& plane = occluder.plane;
    const Interval u = mix(along(a, plane.u, 0), along(b, plane.u, 0), t);
    if (u.high < occluder.bounds.u_min || u.low > occluder.bounds.u_max) return Effect::none;
    const Interval v = mix(along(a, plane.v, 0), along(b, plane.v, 0), t);
    if (v.high < occluder.bounds.v_min || v.low > occluder.bounds.v_max) return Effect::none;
    if (occluder.raster != no_index) {
        switch (occluders.rasters[occluder.raster].look_up({u.low, u.high, v.low, v.high})) {
            case PlaneRaster::Cell::empty: return Effect::none;
            case PlaneRaster::Cell::covered: return Effect::all;
            case PlaneRaster::Cell::mixed: return Effect::some;
        }
    }
    const float du = std::max(u.high - occluder.disc.u, occluder.disc.u - u.low);
    const float dv = std::max(v.high - occluder.disc.v, occluder.disc.v - v.low);
    return du * du + dv * dv < occluder.disc.radius_squared ? Effect::all : Effect::some;
}

Effect effect_of(const Occluder& occluder, const Occluders& occluders, const TurnedBox& a, const TurnedBox& b) {
    const LeafPlane& plane = occluder.plane;
    const Interval ha = along(a, plane.normal, -plane.offset);
    const Interval hb = along(b, plane.normal, -plane.offset);
    const float least = plane.slab - bounds_margin;
    const bool downwards = ha.high > least && hb.low < -least;
    const bool upwards = ha.low < -least && hb.high > least;
    if (!downwards && !upwards) return Effect::none;
    Effect effect = Effect::none;
    if (downwards)
        effect = effect_through(occluder, occluders, a, b, {std::max(ha.low, least), ha.high},
                                {std::max(-hb.high, least), -hb.low});
    if (upwards && effect == Effect::none)
        effect = effect_through(occluder, occluders, a, b, {std::max(-ha.high, least), -ha.low},
                                {std::max(hb.low, least), hb.high});
    if (effect != Effect::all) return effect;
    // All that cross are blocked; do all cross?
    const float sure = plane.slab + bounds_margin;
    const bool all_cross = (ha.low > sure && hb.high < -sure) || (ha.high < -sure && hb.low > sure);
    return all_cross ? Effect::all : Effect::some;
}

}  // namespace

bool cull_occluders(const Occluders& occluders, std::span<const std::uint32_t> list, const TurnedBox& a,
                    const TurnedBox& b, std::vector<std::uint32_t>& left) {
    for (const std::uint32_t k : list) {
        const Effect effect = effect_of(occluders.all[k], occluders, a, b);
        if (effect == Effect::all && occluders.cover_counts) return true;
        if (effect != Effect::none) left.push_back(k);
    }
    return false;
}

}  // namespace vmap
