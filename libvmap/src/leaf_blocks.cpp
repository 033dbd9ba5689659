// SPDX-License-Identifier: Apache-2.0
// Compiled once per instruction set and chosen at run time.
#include "leaf_blocks.h"

#include "node_bounds.h"

#include <algorithm>
#include <cstring>

// The lines up to foreach_target.h are Highway's idiom for compiling this file for every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "leaf_blocks.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vmap::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<float, 16>;
using V = hn::Vec<Lanes>;

constexpr std::size_t width = LeafBlock::width;

/// Leaves of one side of a block as a plane sees them.
struct SeenSide {
    alignas(64) float u[width];
    alignas(64) float v[width];
    alignas(64) float height[width];
};

/// Unfused, as to_plane has it.
HWY_INLINE V dot(const Imath::V3f& axis, V x, V y, V z, float start) {
    const Lanes d;
    return hn::Add(hn::Mul(hn::Set(d, axis.x), x),
                   hn::Add(hn::Mul(hn::Set(d, axis.y), y), hn::Add(hn::Mul(hn::Set(d, axis.z), z), hn::Set(d, start))));
}

template <class Mask>
HWY_INLINE std::uint64_t bits_of(Mask mask, std::size_t at) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(Lanes(), mask, bytes);
    std::uint64_t bits = 0;
    std::memcpy(&bits, bytes, 8);
    return bits << at;
}

HWY_INLINE void see_side(const LeafArrays& leaves, const LeafRange& range, const LeafPlane& plane,
                         SeenSide& HWY_RESTRICT side) {
    const Lanes d;
    for (std::size_t i = 0; i < range.size(); i += hn::Lanes(d)) {
        const auto x = hn::LoadU(d, leaves.centroid[0].data() + range.begin + i);
        const auto y = hn::LoadU(d, leaves.centroid[1].data() + range.begin + i);
        const auto z = hn::LoadU(d, leaves.centroid[2].data() + range.begin + i);
        hn::Store(dot(plane.u, x, y, z, 0), d, side.u + i);
        hn::Store(dot(plane.v, x, y, z, 0), d, side.v + i);
        hn::Store(dot(plane.normal, x, y, z, -plane.offset), d, side.height + i);
    }
}

void keep_facing_kernel(const LeafArrays& leaves, LeafBlock& block) {
    const Lanes d;
    const std::size_t first = block.columns.begin;
    for (std::size_t row = 0; row < block.rows.size(); ++row) {
        const std::size_t a = block.rows.begin + row;
        const Imath::V3f normal(leaves.normal[0][a], leaves.normal[1][a], leaves.normal[2][a]);
        std::uint64_t bits = 0;
        for (std::size_t i = 0; i < block.columns.size(); i += hn::Lanes(d)) {
            const auto column = [&](const std::vector<float>& values) {
                return hn::LoadU(d, values.data() + first + i);
            };
            const auto over_a = dot(normal, column(leaves.centroid[0]), column(leaves.centroid[1]),
                                    column(leaves.centroid[2]), -leaves.offset[a]);
            const auto facing_a = hn::Gt(over_a, hn::Set(d, leaves.slab[a]));
            const auto product = [&](std::size_t axis) {
                return hn::Mul(column(leaves.normal[axis]), hn::Set(d, leaves.centroid[axis][a]));
            };
            const auto over_b = hn::Add(product(0), hn::Add(product(1), hn::Sub(product(2), column(leaves.offset))));
            const auto facing_b = hn::Gt(over_b, column(leaves.slab));
            bits |= bits_of(hn::And(facing_a, facing_b), i);
        }
        block.bits[row] = bits & block.all_columns();
    }
}

/// Where the segments from one row to the columns from i on cross the plane.
struct Crossing {
    V u;
    V v;
};

HWY_INLINE Crossing cross(float ua, float va, float ha, const SeenSide& columns, std::size_t i) {
    const Lanes d;
    const auto height = hn::Set(d, ha);
    const auto t = hn::Div(height, hn::Sub(height, hn::Load(d, columns.height + i)));
    const auto along = [&](float from, const float* to) {
        const auto start = hn::Set(d, from);
        return hn::Add(hn::Mul(t, hn::Sub(hn::Load(d, to), start)), start);
    };
    return {along(ua, columns.u + i), along(va, columns.v + i)};
}

HWY_INLINE std::uint64_t inside_disc(const Crossing& at, const LeafDisc& disc, std::size_t i) {
    const Lanes d;
    const auto du = hn::Sub(at.u, hn::Set(d, disc.u));
    const auto dv = hn::Sub(at.v, hn::Set(d, disc.v));
    const auto squared = hn::Add(hn::Mul(du, du), hn::Mul(dv, dv));
    return bits_of(hn::Lt(squared, hn::Set(d, disc.radius_squared)), i);
}

/// Bits of the columns from i on whose segments the raster's discs block.
HWY_INLINE std::uint64_t inside_raster(const Crossing& at, const PlaneRaster& raster, std::uint64_t wanted,
                                       std::size_t i) {
    const Lanes d;
    const hn::RebindToSigned<Lanes> di;
    const auto per_unit = hn::Set(d, raster.per_unit());
    const auto column = hn::Mul(hn::Sub(at.u, hn::Set(d, raster.u_min())), per_unit);
    const auto row = hn::Mul(hn::Sub(at.v, hn::Set(d, raster.v_min())), per_unit);
    auto in_range =
        hn::And(hn::Ge(column, hn::Zero(d)), hn::Lt(column, hn::Set(d, static_cast<float>(raster.columns()))));
    in_range = hn::And(in_range,
                       hn::And(hn::Ge(row, hn::Zero(d)), hn::Lt(row, hn::Set(d, static_cast<float>(raster.rows())))));
    if (hn::AllFalse(d, in_range)) return 0;
    const auto cell = hn::IfThenElseZero(
        hn::RebindMask(di, in_range),
        hn::Add(hn::Mul(hn::ConvertTo(di, row), hn::Set(di, raster.columns())), hn::ConvertTo(di, column)));
    const auto four = hn::GatherOffset(di, reinterpret_cast<const std::int32_t*>(raster.cells()), cell);
    const auto kind = hn::And(four, hn::Set(di, 0xFF));
    const auto is = [&](PlaneRaster::Cell which) {
        return hn::And(in_range, hn::RebindMask(d, hn::Eq(kind, hn::Set(di, static_cast<std::int32_t>(which)))));
    };
    std::uint64_t blocked = bits_of(is(PlaneRaster::Cell::covered), i);
    std::uint64_t mixed = bits_of(is(PlaneRaster::Cell::mixed), i) & wanted;
    if (mixed == 0) return blocked;
    alignas(64) std::int32_t cells[16];
    alignas(64) float us[16];
    alignas(64) float vs[16];
    hn::Store(cell, di, cells);
    hn::Store(at.u, d, us);
    hn::Store(at.v, d, vs);
    for (; mixed != 0; mixed &= mixed - 1) {
        const auto lane = static_cast<std::size_t>(__builtin_ctzll(mixed)) - i;
        for (const LeafDisc& disc : raster.discs_at(static_cast<std::size_t>(cells[lane]))) {
            const float du = us[lane] - disc.u;
            const float dv = vs[lane] - disc.v;
            if (!(du * du + dv * dv < disc.radius_squared)) continue;
            blocked |= std::uint64_t{1} << (lane + i);
            break;
        }
    }
    return blocked;
}

/// Of these columns of a row, those for which the occluder's leaf is not on the walk.
std::uint64_t not_on_walk(const LeafVisibility& visibility, std::uint32_t k, std::uint32_t a, const LeafBlock& block,
                          std::uint64_t columns) {
    std::uint64_t off = 0;
    for (; columns != 0; columns &= columns - 1) {
        const auto column = static_cast<std::uint32_t>(__builtin_ctzll(columns));
        if (!visibility.may_block(k, a, block.columns.begin + column)) off |= std::uint64_t{1} << column;
    }
    return off;
}

/// Where the columns of a block lie as a plane sees those on one side of it; heights counted positive.
struct ColumnBox {
    float u_min, u_max;
    float v_min, v_max;
    float height_min, height_max;
};

template <bool above>
HWY_INLINE ColumnBox box_of(const SeenSide& side, std::size_t count, float slab) {
    const Lanes d;
    const auto none = hn::Set(d, 1e30F);
    auto u_min = none, v_min = none, h_min = none;
    auto u_max = hn::Neg(none), v_max = u_max, h_max = u_max;
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
        const auto height = above ? hn::Load(d, side.height + i) : hn::Neg(hn::Load(d, side.height + i));
        const auto there = hn::And(hn::FirstN(d, count - i), hn::Gt(height, hn::Set(d, slab)));
        const auto u = hn::Load(d, side.u + i);
        const auto v = hn::Load(d, side.v + i);
        u_min = hn::Min(u_min, hn::IfThenElse(there, u, none));
        u_max = hn::Max(u_max, hn::IfThenElse(there, u, hn::Neg(none)));
        v_min = hn::Min(v_min, hn::IfThenElse(there, v, none));
        v_max = hn::Max(v_max, hn::IfThenElse(there, v, hn::Neg(none)));
        h_min = hn::Min(h_min, hn::IfThenElse(there, height, none));
        h_max = hn::Max(h_max, hn::IfThenElse(there, height, hn::Neg(none)));
    }
    const auto least = [&](V x) { return hn::GetLane(hn::MinOfLanes(d, x)); };
    const auto most = [&](V x) { return hn::GetLane(hn::MaxOfLanes(d, x)); };
    return {least(u_min), most(u_max), least(v_min), most(v_max), least(h_min), most(h_max)};
}

/// Rows from which some segment to the box may cross the plane within the disc.
template <bool above>
HWY_INLINE std::uint64_t rows_that_may_hit(const SeenSide& rows, std::size_t count, const ColumnBox& box, float slab,
                                           const LeafDisc& disc) {
    const Lanes d;
    std::uint64_t bits = 0;
    const auto margin = hn::Set(d, bounds_margin);
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
        const auto height = above ? hn::Load(d, rows.height + i) : hn::Neg(hn::Load(d, rows.height + i));
        const auto t_low = hn::Div(height, hn::Add(height, hn::Set(d, box.height_max)));
        const auto t_high = hn::Div(height, hn::Add(height, hn::Set(d, box.height_min)));
        const auto distance = [&](const float* at, float low, float high, float center) {
            const auto from = hn::Load(d, at + i);
            const auto to_low = hn::Sub(hn::Set(d, low), from);
            const auto to_high = hn::Sub(hn::Set(d, high), from);
            const auto least = hn::Min(hn::MulAdd(t_low, to_low, from), hn::MulAdd(t_high, to_low, from));
            const auto most = hn::Max(hn::MulAdd(t_low, to_high, from), hn::MulAdd(t_high, to_high, from));
            const auto middle = hn::Set(d, center);
            return hn::Max(hn::Sub(hn::Max(hn::Sub(least, middle), hn::Sub(middle, most)), margin), hn::Zero(d));
        };
        const auto du = distance(rows.u, box.u_min, box.u_max, disc.u);
        const auto dv = distance(rows.v, box.v_min, box.v_max, disc.v);
        const auto misses = hn::Gt(hn::MulAdd(du, du, hn::Mul(dv, dv)), hn::Set(d, disc.radius_squared));
        bits |= bits_of(hn::AndNot(misses, hn::Gt(height, hn::Set(d, slab))), i);
    }
    return bits;
}

HWY_INLINE std::uint64_t first_bits(std::size_t count) {
    return count == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1;
}

/// Clears, for every row in `active`, what blocked(crossing, wanted, row, i) returns for the columns from i on.
template <class Blocked>
HWY_INLINE void clear_rows(const SeenSide& rows, const SeenSide& columns, std::uint64_t active, std::uint64_t across,
                           LeafBlock& block, const Blocked& blocked) {
    const Lanes d;
    for (; active != 0; active &= active - 1) {
        const auto row = static_cast<std::size_t>(__builtin_ctzll(active));
        const std::uint64_t wanted = block.bits[row] & across;
        std::uint64_t cleared = 0;
        for (std::size_t i = 0; i < block.columns.size(); i += hn::Lanes(d)) {
            const std::uint64_t here = wanted & first_bits(hn::Lanes(d)) << i;
            if (here != 0)
                cleared |= blocked(cross(rows.u[row], rows.v[row], rows.height[row], columns, i), here, row, i) & here;
        }
        block.bits[row] &= ~cleared;
    }
}

/// The same for all rows from which a disc, or any place when there is none, can be met.
template <class Blocked>
HWY_INLINE bool clear_across(const LeafArrays& leaves, const LeafPlane& plane, const LeafDisc* disc, LeafBlock& block,
                             const Blocked& blocked) {
    const Lanes d;
    SeenSide rows;
    SeenSide columns;
    see_side(leaves, block.rows, plane, rows);
    see_side(leaves, block.columns, plane, columns);
    const auto sides = [&](const SeenSide& side, std::size_t count) {
        std::pair<std::uint64_t, std::uint64_t> bits{0, 0};
        for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
            const auto height = hn::Load(d, side.height + i);
            bits.first |= bits_of(hn::Gt(height, hn::Set(d, plane.slab)), i);
            bits.second |= bits_of(hn::Lt(height, hn::Set(d, -plane.slab)), i);
        }
        bits.first &= first_bits(count);
        bits.second &= first_bits(count);
        return bits;
    };
    const auto [rows_above, rows_below] = sides(rows, block.rows.size());
    const auto [columns_above, columns_below] = sides(columns, block.columns.size());
    const std::size_t row_count = block.rows.size();
    const std::size_t column_count = block.columns.size();
    if (rows_above != 0 && columns_below != 0) {
        std::uint64_t active = rows_above;
        if (disc != nullptr)
            active &= rows_that_may_hit<true>(rows, row_count, box_of<false>(columns, column_count, plane.slab),
                                              plane.slab, *disc);
        clear_rows(rows, columns, active, columns_below, block, blocked);
    }
    if (rows_below != 0 && columns_above != 0) {
        std::uint64_t active = rows_below;
        if (disc != nullptr)
            active &= rows_that_may_hit<false>(rows, row_count, box_of<true>(columns, column_count, plane.slab),
                                               plane.slab, *disc);
        clear_rows(rows, columns, active, columns_above, block, blocked);
    }
    std::uint64_t left = 0;
    for (std::size_t row = 0; row < row_count; ++row) left |= block.bits[row];
    return left != 0;
}

bool clear_behind_wall(const LeafArrays& leaves, const WallOccluder& wall, LeafBlock& block) {
    return clear_across(leaves, wall.plane, nullptr, block,
                        [&](const Crossing& at, std::uint64_t wanted, std::size_t, std::size_t i) {
                            return inside_raster(at, wall.raster, wanted, i);
                        });
}

bool clear_behind_disc(const LeafArrays& leaves, const LoneDisc& disc, LeafBlock& block) {
    return clear_across(
        leaves, disc.plane, &disc.disc, block,
        [&](const Crossing& at, std::uint64_t, std::size_t, std::size_t i) { return inside_disc(at, disc.disc, i); });
}

bool clear_behind_disc_on_walk(const LeafArrays& leaves, const LoneDisc& disc, const LeafVisibility& visibility,
                               LeafBlock& block) {
    return clear_across(leaves, disc.plane, &disc.disc, block,
                        [&](const Crossing& at, std::uint64_t wanted, std::size_t row, std::size_t i) {
                            const auto a = block.rows.begin + static_cast<std::uint32_t>(row);
                            const std::uint64_t inside = inside_disc(at, disc.disc, i) & wanted;
                            return inside & ~not_on_walk(visibility, disc.leaf, a, block, inside);
                        });
}

}  // namespace vmap::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vmap {

HWY_EXPORT(keep_facing_kernel);
HWY_EXPORT(clear_behind_wall);
HWY_EXPORT(clear_behind_disc);
HWY_EXPORT(clear_behind_disc_on_walk);

LeafArrays::LeafArrays(const LeafVisibility& leaves) {
    const std::size_t padded = leaves.size() + LeafBlock::width;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        centroid[axis].resize(padded);
        normal[axis].resize(padded);
    }
    offset.resize(padded);
    slab.resize(padded);
    for (std::size_t leaf = 0; leaf < leaves.size(); ++leaf) {
        const LeafPlane& plane = leaves.planes()[leaves.discs()[leaf].plane];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            centroid[axis][leaf] = leaves.centroids()[leaf][static_cast<int>(axis)];
            normal[axis][leaf] = plane.normal[static_cast<int>(axis)];
        }
        offset[leaf] = plane.offset;
        slab[leaf] = plane.slab;
    }
}

void keep_facing(const LeafArrays& leaves, LeafBlock& block) {
    HWY_DYNAMIC_DISPATCH(keep_facing_kernel)(leaves, block);
}

bool clear_behind(const LeafArrays& leaves, const WallOccluder& wall, LeafBlock& block) {
    return HWY_DYNAMIC_DISPATCH(clear_behind_wall)(leaves, wall, block);
}

bool clear_behind(const LeafArrays& leaves, const LoneDisc& disc, const LeafVisibility& visibility, LeafBlock& block) {
    if (visibility.walks_cells())
        return HWY_DYNAMIC_DISPATCH(clear_behind_disc_on_walk)(leaves, disc, visibility, block);
    return HWY_DYNAMIC_DISPATCH(clear_behind_disc)(leaves, disc, block);
}

}  // namespace vmap
#endif  // HWY_ONCE
