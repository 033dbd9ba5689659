// SPDX-License-Identifier: Apache-2.0
// Traversal of the polygon hierarchy, compiled once per instruction set and chosen at run time.
#include <vmap/polygon_bvh.h>

#include <algorithm>
#include <cmath>

// The lines up to foreach_target.h are Highway's idiom for compiling this file for every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "polygon_bvh_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vmap::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Imath::V3f;
using Lanes = hn::CappedTag<float, PolygonBvh::width>;

constexpr std::size_t width = PolygonBvh::width;

/// Room for every node that can wait: seven a level, and a tree of 2^32 polygons has fewer than 40 levels.
constexpr std::size_t stack_size = 320;

struct Waiting {
    float t;
    std::uint32_t child;
};

/// A ray with what its box tests share.
struct PreparedRay {
    V3f origin;
    V3f direction;
    V3f inverse;

    explicit PreparedRay(const Ray& ray) : origin(ray.origin), direction(ray.direction) {
        for (int axis = 0; axis < 3; ++axis) {
            const float d = direction[axis];
            inverse[axis] = 1.0F / (std::abs(d) < 1e-30F ? std::copysign(1e-30F, d) : d);
        }
    }
};

/// Entry distances of the eight boxes into `entry`, and one bit per box that the segment meets.
HWY_INLINE std::uint32_t meet_boxes(const PolygonBvh::Node& node, const PreparedRay& ray, float t_min, float t_max,
                                    float* HWY_RESTRICT entry) {
    const Lanes d;
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < width; i += hn::Lanes(d)) {
        auto near_t = hn::Set(d, t_min);
        auto far_t = hn::Set(d, t_max);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto origin = hn::Set(d, ray.origin[static_cast<int>(axis)]);
            const auto inverse = hn::Set(d, ray.inverse[static_cast<int>(axis)]);
            // Chosen by the direction, so that the inside-out box of a spare child is never met.
            const bool forward = ray.inverse[static_cast<int>(axis)] >= 0;
            const float* enter = forward ? &node.lower[axis][i] : &node.upper[axis][i];
            const float* leave = forward ? &node.upper[axis][i] : &node.lower[axis][i];
            near_t = hn::Max(near_t, hn::Mul(hn::Sub(hn::LoadU(d, enter), origin), inverse));
            far_t = hn::Min(far_t, hn::Mul(hn::Sub(hn::LoadU(d, leave), origin), inverse));
        }
        // Widened by the rounding of the slab distances, so that no box is missed at its faces.
        const auto met = hn::Le(near_t, hn::Mul(far_t, hn::Set(d, 1.000001F)));
        hn::StoreU(near_t, d, entry + i);
        std::uint8_t mask[8] = {};
        hn::StoreMaskBits(d, met, mask);
        bits |= static_cast<std::uint32_t>(mask[0]) << i;
    }
    return bits;
}

/// What a ray meets in a block of eight polygons.
struct Meeting {
    alignas(64) float t[width];    ///< along the ray
    alignas(64) float key[width];  ///< what decides which is nearer: t, later for backs
    std::uint32_t bits = 0;        ///< one per polygon met
    std::uint32_t fronts = 0;      ///< one per polygon whose front the ray meets
};

HWY_INLINE void meet_polygons(const PolygonBvh::Block& block, const PolygonBvh::Edges* HWY_RESTRICT edges,
                              const PreparedRay& ray, float t_min, float t_max, float coincidence,
                              Meeting& HWY_RESTRICT meeting) {
    const Lanes d;
    meeting.bits = 0;
    meeting.fronts = 0;
    const auto ox = hn::Set(d, ray.origin.x);
    const auto oy = hn::Set(d, ray.origin.y);
    const auto oz = hn::Set(d, ray.origin.z);
    const auto dx = hn::Set(d, ray.direction.x);
    const auto dy = hn::Set(d, ray.direction.y);
    const auto dz = hn::Set(d, ray.direction.z);
    for (std::size_t i = 0; i < width; i += hn::Lanes(d)) {
        const auto nx = hn::LoadU(d, &block.normal[0][i]);
        const auto ny = hn::LoadU(d, &block.normal[1][i]);
        const auto nz = hn::LoadU(d, &block.normal[2][i]);
        const auto height =
            hn::Sub(hn::LoadU(d, &block.offset[i]), hn::MulAdd(nx, ox, hn::MulAdd(ny, oy, hn::Mul(nz, oz))));
        const auto slope = hn::MulAdd(nx, dx, hn::MulAdd(ny, dy, hn::Mul(nz, dz)));
        // A ray in the plane divides zero: the quotient is NaN or infinite and fails the comparisons below.
        const auto t = hn::Div(height, slope);
        auto met = hn::And(hn::Gt(t, hn::Set(d, t_min)), hn::Lt(t, hn::Set(d, t_max)));
        if (hn::AllFalse(d, met)) continue;
        const auto px = hn::MulAdd(t, dx, ox);
        const auto py = hn::MulAdd(t, dy, oy);
        const auto pz = hn::MulAdd(t, dz, oz);
        for (std::uint32_t e = 0; e < block.edge_count; ++e) {
            const auto inside = hn::MulAdd(hn::LoadU(d, &edges[e].normal[0][i]), px,
                                           hn::MulAdd(hn::LoadU(d, &edges[e].normal[1][i]), py,
                                                      hn::Mul(hn::LoadU(d, &edges[e].normal[2][i]), pz)));
            met = hn::And(met, hn::Ge(inside, hn::LoadU(d, &edges[e].offset[i])));
        }
        // Backs wait a little, so that of two coincident sheets the one that faces the ray is nearer.
        const auto front = hn::Lt(slope, hn::Zero(d));
        const auto late = hn::Div(hn::Set(d, coincidence), hn::Max(hn::Abs(slope), hn::Set(d, 1e-2F)));
        hn::StoreU(t, d, meeting.t + i);
        hn::StoreU(hn::Add(t, hn::IfThenZeroElse(front, late)), d, meeting.key + i);
        std::uint8_t mask[8] = {};
        hn::StoreMaskBits(d, met, mask);
        meeting.bits |= static_cast<std::uint32_t>(mask[0]) << i;
        hn::StoreMaskBits(d, front, mask);
        meeting.fronts |= static_cast<std::uint32_t>(mask[0]) << i;
    }
}

/// Puts the met children on the stack, the nearest on top.
HWY_INLINE std::size_t push_children(const PolygonBvh::Node& node, std::uint32_t bits, const float* entry,
                                     Waiting* stack, std::size_t depth) {
    const std::size_t first = depth;
    while (bits != 0) {
        const auto lane = static_cast<std::size_t>(__builtin_ctz(bits));
        bits &= bits - 1;
        const Waiting item{entry[lane], node.child[lane]};
        std::size_t at = depth++;
        for (; at > first && stack[at - 1].t < item.t; --at) stack[at] = stack[at - 1];
        stack[at] = item;
    }
    return depth;
}

RayHit first_hit_of(const PolygonBvh& bvh, const Ray& ray) {
    const PreparedRay prepared(ray);
    RayHit hit;
    float nearest = ray.t_max;
    alignas(64) float t[width];
    Meeting meeting;
    Waiting stack[stack_size];
    std::size_t depth = 0;
    stack[depth++] = {ray.t_min, 0};
    while (depth > 0) {
        const Waiting top = stack[--depth];
        if (top.t > nearest) continue;
        if ((top.child & PolygonBvh::leaf_bit) == 0) {
            const PolygonBvh::Node& node = bvh.nodes()[top.child];
            depth = push_children(node, meet_boxes(node, prepared, ray.t_min, nearest, t), t, stack, depth);
            continue;
        }
        const PolygonBvh::Block& block = bvh.blocks()[top.child & ~PolygonBvh::leaf_bit];
        meet_polygons(block, bvh.edges().data() + block.first_edge, prepared, ray.t_min, nearest, bvh.coincidence(),
                      meeting);
        for (std::uint32_t bits = meeting.bits; bits != 0; bits &= bits - 1) {
            const auto lane = static_cast<std::size_t>(__builtin_ctz(bits));
            const float key = meeting.key[lane];
            if (key > nearest || (key == nearest && block.polygon[lane] > hit.polygon)) continue;
            nearest = key;
            hit = {meeting.t[lane], block.polygon[lane], (meeting.fronts >> lane & 1U) != 0};
        }
    }
    return hit;
}

bool any_hit_of(const PolygonBvh& bvh, const Ray& ray) {
    const PreparedRay prepared(ray);
    alignas(64) float t[width];
    Meeting meeting;
    Waiting stack[stack_size];
    std::size_t depth = 0;
    stack[depth++] = {ray.t_min, 0};
    while (depth > 0) {
        const std::uint32_t child = stack[--depth].child;
        if ((child & PolygonBvh::leaf_bit) == 0) {
            const PolygonBvh::Node& node = bvh.nodes()[child];
            depth = push_children(node, meet_boxes(node, prepared, ray.t_min, ray.t_max, t), t, stack, depth);
            continue;
        }
        const PolygonBvh::Block& block = bvh.blocks()[child & ~PolygonBvh::leaf_bit];
        meet_polygons(block, bvh.edges().data() + block.first_edge, prepared, ray.t_min, ray.t_max, 0, meeting);
        if (meeting.bits != 0) return true;
    }
    return false;
}

void first_hits_kernel(const PolygonBvh& bvh, std::span<const Ray> rays, std::span<RayHit> hits) {
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = first_hit_of(bvh, rays[i]);
}

void any_hits_kernel(const PolygonBvh& bvh, std::span<const Ray> rays, std::span<std::uint8_t> blocked) {
    for (std::size_t i = 0; i < rays.size(); ++i) blocked[i] = any_hit_of(bvh, rays[i]) ? 1 : 0;
}

/// One bit per box that is not wholly outside one of the half-spaces.
HWY_INLINE std::uint32_t boxes_in(const PolygonBvh::Node& node, std::span<const HalfSpace> shaft) {
    const Lanes d;
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < width; i += hn::Lanes(d)) {
        auto inside = hn::Eq(hn::Zero(d), hn::Zero(d));
        for (const HalfSpace& half : shaft) {
            auto least = hn::Zero(d);  // the corner that lies deepest in the half-space
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const float n = half.normal[static_cast<int>(axis)];
                const float* corner = n > 0 ? &node.lower[axis][i] : &node.upper[axis][i];
                least = hn::MulAdd(hn::Set(d, n), hn::LoadU(d, corner), least);
            }
            inside = hn::And(inside, hn::Le(least, hn::Set(d, half.offset)));
        }
        std::uint8_t mask[8] = {};
        hn::StoreMaskBits(d, inside, mask);
        bits |= static_cast<std::uint32_t>(mask[0]) << i;
    }
    return bits;
}

void polygons_in_kernel(const PolygonBvh& bvh, std::span<const HalfSpace> shaft, std::vector<std::uint32_t>& found) {
    std::uint32_t stack[stack_size];
    std::size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const PolygonBvh::Node& node = bvh.nodes()[stack[--depth]];
        for (std::uint32_t bits = boxes_in(node, shaft); bits != 0; bits &= bits - 1) {
            const std::uint32_t child = node.child[static_cast<std::size_t>(__builtin_ctz(bits))];
            if (child == PolygonBvh::no_child) continue;
            if ((child & PolygonBvh::leaf_bit) == 0) {
                stack[depth++] = child;
                continue;
            }
            for (const std::uint32_t polygon : bvh.blocks()[child & ~PolygonBvh::leaf_bit].polygon)
                if (polygon != RayHit::miss) found.push_back(polygon);
        }
    }
}

}  // namespace vmap::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vmap {

HWY_EXPORT(first_hits_kernel);
HWY_EXPORT(any_hits_kernel);
HWY_EXPORT(polygons_in_kernel);

void PolygonBvh::first_hits(std::span<const Ray> rays, std::span<RayHit> hits) const {
    assert(rays.size() == hits.size());
    if (empty()) return std::fill(hits.begin(), hits.end(), RayHit{});
    HWY_DYNAMIC_DISPATCH(first_hits_kernel)(*this, rays, hits);
}

void PolygonBvh::any_hits(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const {
    assert(rays.size() == blocked.size());
    if (empty()) return std::fill(blocked.begin(), blocked.end(), std::uint8_t{0});
    HWY_DYNAMIC_DISPATCH(any_hits_kernel)(*this, rays, blocked);
}

void PolygonBvh::polygons_in(std::span<const HalfSpace> shaft, std::vector<std::uint32_t>& found) const {
    if (!empty()) HWY_DYNAMIC_DISPATCH(polygons_in_kernel)(*this, shaft, found);
}

}  // namespace vmap
#endif  // HWY_ONCE
