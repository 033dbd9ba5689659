// SPDX-License-Identifier: Apache-2.0
// Compiled once per instruction set and chosen at run time.
#include "disc_list.h"

#include <algorithm>
#include <array>
#include <bit>

// The lines up to foreach_target.h are Highway's idiom for compiling this file for every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "disc_list.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vmap::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<float, 16>;
using V = hn::Vec<Lanes>;

/// A range for each of some discs.
struct Interval {
    V low;
    V high;
};

struct Axis {
    V x;
    V y;
    V z;
};

HWY_INLINE Axis load_axis(const DiscList& list, DiscList::Field first, std::size_t i) {
    const Lanes d;
    const auto field = [&](std::size_t f) {
        return hn::LoadU(d, list.field(static_cast<DiscList::Field>(static_cast<std::size_t>(first) + f)) + i);
    };
    return {field(0), field(1), field(2)};
}

HWY_INLINE V dot(const Axis& axis, const Imath::V3f& v) {
    const Lanes d;
    return hn::MulAdd(axis.x, hn::Set(d, v.x), hn::MulAdd(axis.y, hn::Set(d, v.y), hn::Mul(axis.z, hn::Set(d, v.z))));
}

HWY_INLINE Interval along(const TurnedBox& box, const Axis& axis) {
    const V middle = dot(axis, box.center);
    const V reach = hn::Add(hn::Abs(dot(axis, box.half_axes[0])),
                            hn::Add(hn::Abs(dot(axis, box.half_axes[1])), hn::Abs(dot(axis, box.half_axes[2]))));
    return {hn::Sub(middle, reach), hn::Add(middle, reach)};
}

/// Range of a + t (b - a).
HWY_INLINE Interval mix(const Interval& a, const Interval& b, const Interval& t) {
    const Lanes d;
    const V low = hn::Sub(b.low, a.low);
    const V high = hn::Sub(b.high, a.high);
    const V margin = hn::Set(d, bounds_margin);
    return {hn::Sub(hn::Min(hn::MulAdd(t.low, low, a.low), hn::MulAdd(t.high, low, a.low)), margin),
            hn::Add(hn::Max(hn::MulAdd(t.low, high, a.high), hn::MulAdd(t.high, high, a.high)), margin)};
}

/// What discs do to the segments from heights `ha` on one side to heights `hb` on the other, both counted positive.
struct Effect {
    hn::Mask<Lanes> some;
    hn::Mask<Lanes> all;
};

HWY_INLINE Effect through(const DiscList& list, std::size_t i, const Interval& ua, const Interval& ub,
                          const Interval& va, const Interval& vb, const Interval& ha, const Interval& hb) {
    const Lanes d;
    const Interval t{hn::Div(ha.low, hn::Add(ha.low, hb.high)), hn::Div(ha.high, hn::Add(ha.high, hb.low))};
    const Interval u = mix(ua, ub, t);
    const Interval v = mix(va, vb, t);
    const V du = hn::LoadU(d, list.field(DiscList::du) + i);
    const V dv = hn::LoadU(d, list.field(DiscList::dv) + i);
    const V squared = hn::LoadU(d, list.field(DiscList::radius_squared) + i);
    const V zero = hn::Zero(d);
    // Nearest and farthest place of the footprint as the disc's centre sees it. The footprint has its margin.
    const V near_u = hn::Max(hn::Max(hn::Sub(u.low, du), hn::Sub(du, u.high)), zero);
    const V near_v = hn::Max(hn::Max(hn::Sub(v.low, dv), hn::Sub(dv, v.high)), zero);
    const V far_u = hn::Max(hn::Sub(u.high, du), hn::Sub(du, u.low));
    const V far_v = hn::Max(hn::Sub(v.high, dv), hn::Sub(dv, v.low));
    // Not "less than": a disc of infinite radius, whose comparisons may be of NaN, counts as reaching in.
    const auto misses = hn::Gt(hn::MulAdd(near_u, near_u, hn::Mul(near_v, near_v)), squared);
    return {hn::Not(misses), hn::Lt(hn::MulAdd(far_u, far_u, hn::Mul(far_v, far_v)), squared)};
}

bool cull_kernel(const DiscList& list, const TurnedBox& a, const TurnedBox& b, bool cover_counts, DiscList& left) {
    const Lanes d;
    std::size_t kept = 0;
    const V margin = hn::Set(d, bounds_margin);
    for (std::size_t i = 0; i < list.size(); i += hn::Lanes(d)) {
        const Axis normal = load_axis(list, DiscList::nx, i);
        const V offset = hn::LoadU(d, list.field(DiscList::offset) + i);
        const V slab = hn::LoadU(d, list.field(DiscList::slab) + i);
        Interval ha = along(a, normal);
        Interval hb = along(b, normal);
        ha = {hn::Sub(ha.low, offset), hn::Sub(ha.high, offset)};
        hb = {hn::Sub(hb.low, offset), hn::Sub(hb.high, offset)};
        const V least = hn::Sub(slab, margin);
        const V minus_least = hn::Neg(least);
        const auto there = hn::FirstN(d, list.size() - i);
        const auto downwards = hn::And(there, hn::And(hn::Gt(ha.high, least), hn::Lt(hb.low, minus_least)));
        const auto upwards = hn::And(there, hn::And(hn::Lt(ha.low, minus_least), hn::Gt(hb.high, least)));
        if (hn::AllFalse(d, hn::Or(downwards, upwards))) continue;

        const Axis u = load_axis(list, DiscList::ux, i);
        const Axis v = load_axis(list, DiscList::vx, i);
        const Interval ua = along(a, u);
        const Interval ub = along(b, u);
        const Interval va = along(a, v);
        const Interval vb = along(b, v);
        const V sure = hn::Add(slab, margin);
        const V minus_sure = hn::Neg(sure);
        auto stays = hn::FirstN(d, 0);
        auto blocks_all = hn::FirstN(d, 0);
        if (!hn::AllFalse(d, downwards)) {
            const Effect down = through(list, i, ua, ub, va, vb, {hn::Max(ha.low, least), ha.high},
                                        {hn::Max(hn::Neg(hb.high), least), hn::Neg(hb.low)});
            stays = hn::And(downwards, down.some);
            blocks_all = hn::And(down.all, hn::And(hn::Gt(ha.low, sure), hn::Lt(hb.high, minus_sure)));
        }
        if (!hn::AllFalse(d, upwards)) {
            const Effect up = through(list, i, ua, ub, va, vb, {hn::Max(hn::Neg(ha.high), least), hn::Neg(ha.low)},
                                      {hn::Max(hb.low, least), hb.high});
            stays = hn::Or(stays, hn::And(upwards, up.some));
            const auto all_up = hn::And(up.all, hn::And(hn::Lt(ha.high, minus_sure), hn::Gt(hb.low, sure)));
            blocks_all = hn::Or(blocks_all, all_up);
        }
        if (cover_counts && !hn::AllFalse(d, hn::And(there, blocks_all))) return true;
        if (hn::AllFalse(d, stays)) continue;
        for (std::size_t f = 0; f < DiscList::fields; ++f) {
            const auto field = static_cast<DiscList::Field>(f);
            // Not CompressStore, which some processors take hundreds of cycles for.
            hn::StoreU(hn::Compress(hn::LoadU(d, list.field(field) + i), stays), d, left.field(field) + kept);
        }
        kept += hn::CountTrue(d, stays);
    }
    left.set_size(kept);
    return false;
}

void middle_kernel(const DiscList& list, const Imath::V3f& from, const Imath::V3f& to,
                   std::vector<std::uint32_t>& leaves) {
    const Lanes d;
    const V margin = hn::Set(d, bounds_margin);
    for (std::size_t i = 0; i < list.size(); i += hn::Lanes(d)) {
        const Axis normal = load_axis(list, DiscList::nx, i);
        const V offset = hn::LoadU(d, list.field(DiscList::offset) + i);
        const V from_height = hn::Sub(dot(normal, from), offset);
        const V to_height = hn::Sub(dot(normal, to), offset);
        auto crossed = hn::And(hn::Lt(hn::Min(from_height, to_height), margin),
                               hn::Gt(hn::Max(from_height, to_height), hn::Neg(margin)));
        crossed = hn::And(crossed, hn::FirstN(d, list.size() - i));
        if (hn::AllFalse(d, crossed)) continue;
        const Axis u = load_axis(list, DiscList::ux, i);
        const Axis v = load_axis(list, DiscList::vx, i);
        const V t = hn::Div(from_height, hn::Sub(from_height, to_height));
        const auto distance = [&](const Axis& axis, DiscList::Field center) {
            const V start = dot(axis, from);
            const V at = hn::MulAdd(t, hn::Sub(dot(axis, to), start), start);
            const V off = hn::Abs(hn::Sub(at, hn::LoadU(d, list.field(center) + i)));
            return hn::Max(hn::Sub(off, margin), hn::Zero(d));
        };
        const V du = distance(u, DiscList::du);
        const V dv = distance(v, DiscList::dv);
        const V squared = hn::LoadU(d, list.field(DiscList::radius_squared) + i);
        crossed = hn::AndNot(hn::Gt(hn::MulAdd(du, du, hn::Mul(dv, dv)), squared), crossed);
        std::uint8_t bytes[8] = {};
        hn::StoreMaskBits(d, crossed, bytes);
        for (std::uint32_t bits = bytes[0] | static_cast<std::uint32_t>(bytes[1]) << 8; bits != 0; bits &= bits - 1)
            leaves.push_back(std::bit_cast<std::uint32_t>(
                list.field(DiscList::leaf)[i + static_cast<std::size_t>(__builtin_ctz(bits))]));
    }
}

}  // namespace vmap::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vmap {

HWY_EXPORT(cull_kernel);
HWY_EXPORT(middle_kernel);

DiscList::DiscList(std::size_t capacity)
    : stride_(capacity + 16), values_(std::make_unique_for_overwrite<float[]>(fields * stride_)) {}

DiscList::DiscList(std::span<const LoneDisc> discs) : DiscList(discs.size()) {
    size_ = discs.size();
    std::fill_n(values_.get(), fields * stride_, 0.0F);
    for (std::size_t i = 0; i < discs.size(); ++i) {
        const LeafPlane& plane = discs[i].plane;
        const LeafDisc& disc = discs[i].disc;
        const std::array<float, fields> values{
            plane.normal.x, plane.normal.y, plane.normal.z, plane.offset,        plane.slab,
            plane.u.x,      plane.u.y,      plane.u.z,      plane.v.x,           plane.v.y,
            plane.v.z,      disc.u,         disc.v,         disc.radius_squared, std::bit_cast<float>(discs[i].leaf)};
        for (std::size_t f = 0; f < fields; ++f) field(static_cast<Field>(f))[i] = values[f];
    }
}

LoneDisc DiscList::at(std::size_t i) const {
    const auto vector = [&](Field first) {
        const auto component = [&](std::size_t f) { return field(static_cast<Field>(first + f))[i]; };
        return Imath::V3f(component(0), component(1), component(2));
    };
    LoneDisc disc;
    disc.plane = {vector(nx), vector(ux), vector(vx), field(offset)[i], field(slab)[i]};
    disc.disc = {0, field(du)[i], field(dv)[i], field(radius_squared)[i]};
    disc.leaf = std::bit_cast<std::uint32_t>(field(leaf)[i]);
    return disc;
}

bool cull_discs(const DiscList& list, const TurnedBox& a, const TurnedBox& b, bool cover_counts, DiscList& left) {
    return HWY_DYNAMIC_DISPATCH(cull_kernel)(list, a, b, cover_counts, left);
}

void find_on_middle(const DiscList& list, const Imath::V3f& from, const Imath::V3f& to,
                    std::vector<std::uint32_t>& leaves) {
    HWY_DYNAMIC_DISPATCH(middle_kernel)(list, from, to, leaves);
}

}  // namespace vmap
#endif  // HWY_ONCE
