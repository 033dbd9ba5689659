// SPDX-License-Identifier: Apache-2.0
// The inner loop is compiled once per instruction set and chosen at run time.
#include "pencil_tracer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

// The lines up to foreach_target.h are Highway's idiom for compiling this file for every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pencil_tracer.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vmap::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// For every direction the largest inverse distance, and the view that it belongs to; 0 where nothing is met.
void nearest_views(std::span<const PencilTracer::View> views, std::span<const Imath::V3f> edges,
                   const DirectionSet& directions, float* HWY_RESTRICT inverse, std::int32_t* HWY_RESTRICT view) {
    const hn::CappedTag<float, 8> d;
    const hn::RebindToSigned<decltype(d)> di;
    const std::size_t lanes = hn::Lanes(d);
    for (std::size_t i = 0; i < directions.size(); i += lanes) {
        const auto dx = hn::LoadU(d, directions.x.data() + i);
        const auto dy = hn::LoadU(d, directions.y.data() + i);
        const auto dz = hn::LoadU(d, directions.z.data() + i);
        auto best = hn::Zero(d);
        auto best_view = hn::Set(di, -1);
        for (std::size_t v = 0; v < views.size(); ++v) {
            const PencilTracer::View& seen = views[v];
            const auto nearness =
                hn::MulAdd(hn::Set(d, seen.plane.x), dx,
                           hn::MulAdd(hn::Set(d, seen.plane.y), dy, hn::Mul(hn::Set(d, seen.plane.z), dz)));
            auto met = hn::Gt(nearness, best);
            if (hn::AllFalse(d, met)) continue;
            for (std::uint32_t e = seen.first_edge; e < seen.first_edge + seen.edge_count; ++e) {
                const Imath::V3f& m = edges[e];
                const auto inside =
                    hn::MulAdd(hn::Set(d, m.x), dx, hn::MulAdd(hn::Set(d, m.y), dy, hn::Mul(hn::Set(d, m.z), dz)));
                met = hn::And(met, hn::Ge(inside, hn::Zero(d)));
            }
            best = hn::IfThenElse(met, nearness, best);
            best_view = hn::IfThenElse(hn::RebindMask(di, met), hn::Set(di, static_cast<std::int32_t>(v)), best_view);
        }
        hn::StoreU(best, d, inverse + i);
        hn::StoreU(best_view, di, view + i);
    }
}

}  // namespace vmap::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vmap {

HWY_EXPORT(nearest_views);

namespace {

using Imath::V3f;

/// So many polygons are cheaper one by one than in a hierarchy,
constexpr std::size_t most_large = 48;
/// if each of them is that share of the whole surface.
constexpr double least_large_share = 1e-3;

V3f area_vector(std::span<const V3f> vertices) {
    Imath::V3d sum(0);
    for (std::size_t i = 1; i + 1 < vertices.size(); ++i)
        sum += Imath::V3d(vertices[i] - vertices[0]).cross(Imath::V3d(vertices[i + 1] - vertices[0]));
    return V3f(sum / 2);
}

}  // namespace

PencilTracer::PencilTracer(const PolygonSet& polygons, std::span<const float> dilation) {
    if (polygons.empty()) return;
    std::vector<float> areas(polygons.size());
    float largest = 0;
    for (std::size_t p = 0; p < areas.size(); ++p) {
        areas[p] = area_vector(polygons[p]).length();
        for (const V3f& v : polygons[p]) largest = std::max({largest, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    }
    const float rounding = largest * 4e-7F;
    coincidence_ = largest * 2e-6F;

    std::vector<std::uint32_t> by_area(areas.size());
    std::iota(by_area.begin(), by_area.end(), 0U);
    const std::size_t candidates = std::min(most_large, by_area.size());
    const auto ranked = by_area.begin() + static_cast<std::ptrdiff_t>(candidates);
    std::partial_sort(by_area.begin(), ranked, by_area.end(), [&](std::uint32_t a, std::uint32_t b) {
        return areas[a] != areas[b] ? areas[a] > areas[b] : a < b;
    });
    const double total = std::accumulate(areas.begin(), areas.end(), 0.0);
    std::vector<bool> is_large(areas.size(), false);
    for (auto i = by_area.begin(); i != ranked; ++i)
        is_large[*i] = areas[*i] > 0 &&
                       (areas.size() <= most_large || static_cast<double>(areas[*i]) >= least_large_share * total);

    PolygonSet rest;
    std::vector<float> rest_dilation;
    for (std::uint32_t p = 0; p < polygons.size(); ++p) {
        if (is_large[p]) {
            add_large(p, polygons[p], rounding + dilation[p]);
            continue;
        }
        rest.add(polygons[p]);
        rest_dilation.push_back(dilation[p]);
        small_index_.push_back(p);
    }
    small_ = PolygonBvh(rest, {rest_dilation});
}

void PencilTracer::add_large(std::uint32_t index, std::span<const V3f> vertices, float dilation) {
    Large large;
    large.polygon = index;
    large.normal = area_vector(vertices).normalized();
    V3f center(0);
    for (const V3f& v : vertices) center += v;
    large.offset = large.normal.dot(center / static_cast<float>(vertices.size()));
    large.vertices.assign(vertices.begin(), vertices.end());
    large.first_edge = static_cast<std::uint32_t>(edges_.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const V3f inward = large.normal.cross(vertices[(i + 1) % vertices.size()] - vertices[i]);
        const float length = inward.length();
        if (length > 0) edges_.push_back({inward / length, inward.dot(vertices[i]) / length - dilation});
    }
    large.edge_count = static_cast<std::uint32_t>(edges_.size()) - large.first_edge;
    large_.push_back(std::move(large));
}

void PencilTracer::first_hits(const V3f& origin, const NormalFrame& frame, const DirectionSet& directions,
                              std::span<RayHit> hits) const {
    std::vector<View> views;
    std::vector<std::uint32_t> seen;  // which polygon a view is of
    std::vector<V3f> edges;
    views.reserve(large_.size());
    seen.reserve(large_.size());
    edges.reserve(edges_.size());
    for (std::uint32_t p = 0; p < large_.size(); ++p) {
        const Large& large = large_[p];
        const float height = large.offset - large.normal.dot(origin);  // along the normal, from the origin to the plane
        if (height == 0 || std::none_of(large.vertices.begin(), large.vertices.end(),
                                        [&](const V3f& v) { return frame.z.dot(v - origin) > 0; }))
            continue;
        const float side = height < 0 ? -1.0F : 1.0F;
        // Backs wait a little, so that of two coincident sheets the one that faces the ray is nearer.
        const float distance = std::abs(height) + (height > 0 ? coincidence_ : 0.0F);
        const V3f normal = frame.local_from_world(large.normal) * side;
        View view{normal / distance, static_cast<std::uint32_t>(edges.size()), large.edge_count};
        for (std::uint32_t e = large.first_edge; e < large.first_edge + large.edge_count; ++e) {
            const Edge& edge = edges_[e];
            edges.push_back(normal * (edge.normal.dot(origin) - edge.offset) +
                            frame.local_from_world(edge.normal) * std::abs(height));
        }
        views.push_back(view);
        seen.push_back(p);
    }

    std::vector<float> inverse(directions.size());
    std::vector<std::int32_t> view(directions.size());
    HWY_DYNAMIC_DISPATCH(nearest_views)(views, edges, directions, inverse.data(), view.data());
    for (std::size_t k = 0; k < hits.size(); ++k) {
        hits[k] = RayHit{};
        if (view[k] < 0) continue;
        const Large& large = large_[seen[static_cast<std::size_t>(view[k])]];
        hits[k] = {1 / inverse[k], large.polygon, large.normal.dot(origin) > large.offset};
    }
    if (small_.empty()) return;

    for (std::size_t k = 0; k < hits.size(); ++k) {
        const V3f way = frame.world_from_local({directions.x[k], directions.y[k], directions.z[k]});
        const RayHit near = small_.first_hit({origin, way, 0, hits[k].t});
        if (near) hits[k] = {near.t, small_index_[near.polygon], near.front};
    }
}

}  // namespace vmap
#endif  // HWY_ONCE
