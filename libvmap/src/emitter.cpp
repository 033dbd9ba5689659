// SPDX-License-Identifier: Apache-2.0
#include "emitter.h"

#include <vmap/outline.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace vmap {
namespace {

using Imath::C3f;
using Imath::V2d;
using Imath::V3d;
using Imath::V3f;

double triangle_area(const Emitter& emitter, std::size_t i) {
    const std::vector<V3d>& v = emitter.vertices;
    return (v[i] - v[0]).cross(v[i + 1] - v[0]).length() / 2;
}

Emitter make_emitter(std::vector<V3d> vertices, const Patch& patch, std::uint32_t index, const C3f& radiance) {
    Emitter emitter{std::move(vertices), patch.normal, {}, radiance};
    for (const V3d& v : emitter.vertices) emitter.bounds.extendBy(V3f(v));
    for (std::size_t i = 1; i + 1 < emitter.vertices.size(); ++i)
        emitter.area += static_cast<float>(triangle_area(emitter, i));
    emitter.lift = patch.flat ? 0 : patch.spacing();
    emitter.patch = index;
    return emitter;
}

/// Area-weighted mean of the emission of a range of points, and whether they differ.
struct MeanEmission {
    C3f mean{0, 0, 0};
    double area = 0;
    bool uniform = true;
};
MeanEmission mean_emission(const Surface& surface, std::uint32_t first, std::uint32_t count) {
    V3d sum(0);
    MeanEmission result;
    const C3f& probe = surface.cloud.emission[surface.set.point_order[first]];
    for (std::uint32_t k = first; k < first + count; ++k) {
        const std::uint32_t i = surface.set.point_order[k];
        const auto area = static_cast<double>(surface.cloud.areas[i]);
        sum += V3d(surface.cloud.emission[i]) * area;
        result.area += area;
        result.uniform = result.uniform && (surface.cloud.emission[i] - probe).length() <= 1e-3F * probe.length();
    }
    sum /= result.area;
    result.mean = C3f(static_cast<float>(sum.x), static_cast<float>(sum.y), static_cast<float>(sum.z));
    return result;
}

/// Root mean square sine of the angles between the normals of a patch's points and its own, scaled to an even spread.
float turn_of(const Surface& surface, const Patch& patch) {
    float sum = 0;
    for (const std::uint32_t i : surface.set.points_of(patch))
        sum += patch.normal.cross(surface.cloud.normals[i]).length2();
    // Along the direction in which a group turns away: half of the square; an even spread of +-a has a mean square
    // a^2/3.
    return std::sqrt(1.5F * sum / static_cast<float>(patch.point_count));
}

/// One tile of a flat patch as a polygon.
std::vector<V3d> outline_of_tile(const Surface& surface, const Patch& patch, const Tile& tile, double area) {
    std::vector<V2d> flat;
    for (std::uint32_t k = tile.first_point; k < tile.first_point + tile.point_count; ++k)
        flat.emplace_back(patch.to_plane(surface.cloud.positions[surface.set.point_order[k]]));
    std::vector<V3d> vertices;
    for (const V2d& q : rough_outline(flat, area, static_cast<double>(patch.spacing())))
        vertices.push_back(V3d(patch.center) + V3d(patch.u) * q.x + V3d(patch.v) * q.y);
    return vertices;
}

}  // namespace

std::vector<Emitter> find_emitters(const Surface& surface) {
    std::vector<Emitter> emitters;
    std::size_t tile = 0;
    for (std::uint32_t p = 0; p < surface.set.patches.size(); ++p) {
        const Patch& patch = surface.set.patches[p];
        const std::size_t first_tile = tile;
        while (tile < surface.tiles.size() && surface.tiles[tile].patch == p) ++tile;
        if (!patch.emits) continue;
        const MeanEmission whole = mean_emission(surface, patch.first_point, patch.point_count);
        if (whole.uniform || !patch.flat) {
            std::vector<V3d> vertices;
            for (const V3f& v : surface.set.outlines[p]) vertices.emplace_back(v);
            emitters.push_back(make_emitter(std::move(vertices), patch, p, whole.mean));
            if (!patch.flat) emitters.back().turn = turn_of(surface, patch);
            continue;
        }
        for (std::size_t t = first_tile; t < tile; ++t) {
            const Tile& part = surface.tiles[t];
            const MeanEmission own = mean_emission(surface, part.first_point, part.point_count);
            emitters.push_back(make_emitter(outline_of_tile(surface, patch, part, own.area), patch, p, own.mean));
        }
    }
    return emitters;
}

V3d place_on(const Emitter& emitter, const V2d& sample) {
    const std::vector<V3d>& v = emitter.vertices;
    double target = sample.x * static_cast<double>(emitter.area);
    std::size_t i = 1;
    double width = triangle_area(emitter, i);
    while (i + 2 < v.size() && target > width) {
        target -= width;
        width = triangle_area(emitter, ++i);
    }
    const double along = std::sqrt(width > 0 ? std::clamp(target / width, 0.0, 1.0) : 0.5);
    return v[0] * (1 - along) + v[i] * (along * (1 - sample.y)) + v[i + 1] * (along * sample.y);
}

}  // namespace vmap
