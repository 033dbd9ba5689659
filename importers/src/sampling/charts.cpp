// SPDX-License-Identifier: GPL-3.0-or-later
#include "charts.h"

#include "welded_mesh.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <utility>

namespace vmap {
namespace {

using Imath::V3d;
using Imath::V3f;

constexpr std::uint32_t none = no_neighbour;
constexpr float flat_cosine = 0.99996F;  ///< half a degree
constexpr float chart_cosine = 0.7F;     ///< between a chart and the smoothed normals of its parts
constexpr float steepest_cosine = 0.4F;  ///< a plane shows the steepest triangle at this share of its area
constexpr float smooth_cosine = 0.5F;    ///< sheets that meet at a sharper edge are sampled on their own

/// Edges as the lit side sees them, so that front and back of one face run opposite ways.
std::vector<TriangleEdge> edges_of(const LitSurface& surface) {
    const WeldedVertices vertices(*surface.scene, surface.origin);
    std::vector<TriangleEdge> edges(3 * surface.triangles.size());
    tbb::parallel_for(std::size_t{0}, surface.triangles.size(), [&](std::size_t t) {
        const LitTriangle& triangle = surface.triangles[t];
        const std::size_t instance = triangle.instance;
        auto numbers = vertices.of(instance, triangle.face - surface.first_faces[instance]);
        const bool is_mirrored_side = is_mirrored(surface.scene->instances[instance]) != triangle.is_back();
        if (is_mirrored_side) std::swap(numbers[1], numbers[2]);
        for (int k = 0; k < 3; ++k)
            edges[3 * t + k] = triangle_edge(static_cast<std::uint32_t>(t), is_mirrored_side ? 2 - k : k, numbers[k],
                                             numbers[(k + 1) % 3]);
    });
    tbb::parallel_sort(edges);
    return edges;
}

/// The other side of the same sheet over each edge: it runs through the edge the other way, and of several the one
/// that goes on most straightly.
Neighbours find_neighbours(const LitSurface& surface) {
    const std::vector<TriangleEdge> edges = edges_of(surface);
    const std::vector<LitTriangle>& triangles = surface.triangles;
    Neighbours neighbours(triangles.size(), {none, none, none});
    for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
        for (end = begin; end < edges.size() && edges[end].vertices == edges[begin].vertices;) ++end;
        if (end - begin > 64) continue;  // a knot of faces in one place
        for (std::size_t k = begin; k < end; ++k) {
            const LitTriangle& here = triangles[edges[k].triangle];
            float best = smooth_cosine;
            for (std::size_t other = begin; other < end; ++other) {
                const LitTriangle& there = triangles[edges[other].triangle];
                if (edges[other].is_ascending == edges[k].is_ascending || there.face == here.face) continue;
                const float cosine = here.normal.dot(there.normal);
                if (cosine <= best) continue;
                best = cosine;
                neighbours[edges[k].triangle][edges[k].corner] = edges[other].triangle;
            }
        }
    }
    return neighbours;
}

/// Normals averaged over a few triangles around where these are smaller than the points' shares: such bumps would tear
/// charts to pieces.
std::vector<V3f> smooth_normals(const LitSurface& surface, const Neighbours& neighbours, double spacing) {
    constexpr int rounds = 4;
    const auto is_small = [&](std::uint32_t t) { return surface.triangles[t].area < spacing * spacing; };
    std::vector<V3f> normals(surface.triangles.size());
    for (std::size_t t = 0; t < normals.size(); ++t) normals[t] = surface.triangles[t].normal;
    std::vector<V3f> next = normals;
    for (int round = 0; round < rounds; ++round) {
        tbb::parallel_for(std::uint32_t{0}, static_cast<std::uint32_t>(normals.size()), [&](std::uint32_t t) {
            if (!is_small(t)) return;
            V3f sum = normals[t];
            for (const std::uint32_t other : neighbours[t])
                if (other != none) sum += normals[other];
            next[t] = sum.normalized();
        });
        normals.swap(next);
    }
    return normals;
}

/// Numbers of things, largest area first.
std::vector<std::uint32_t> by_area(std::size_t count, const auto& area_of) {
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0U);
    tbb::parallel_sort(order, [&](std::uint32_t a, std::uint32_t b) {
        return area_of(a) != area_of(b) ? area_of(a) > area_of(b) : a < b;
    });
    return order;
}

/// Triangles of each flat part, one part after the other.
struct FlatParts {
    std::vector<std::size_t> first{0};
    std::vector<std::uint32_t> triangles;

    [[nodiscard]] std::span<const std::uint32_t> of(std::uint32_t flat) const {
        return {triangles.data() + first[flat], triangles.data() + first[flat + 1]};
    }
};

FlatParts find_flat_parts(const LitSurface& surface, const Neighbours& neighbours, Charts& result) {
    FlatParts parts;
    result.flat_of.assign(surface.triangles.size(), none);
    for (const std::uint32_t seed :
         by_area(surface.triangles.size(), [&](std::uint32_t t) { return surface.triangles[t].area; })) {
        if (result.flat_of[seed] != none) continue;
        const auto number = static_cast<std::uint32_t>(parts.first.size() - 1);
        const V3f& normal = surface.triangles[seed].normal;
        double area = 0;
        result.flat_of[seed] = number;
        parts.triangles.push_back(seed);
        for (std::size_t next = parts.first.back(); next < parts.triangles.size(); ++next) {
            area += surface.triangles[parts.triangles[next]].area;
            for (const std::uint32_t other : neighbours[parts.triangles[next]]) {
                if (other == none || result.flat_of[other] != none) continue;
                if (surface.triangles[other].normal.dot(normal) < flat_cosine) continue;
                result.flat_of[other] = number;
                parts.triangles.push_back(other);
            }
        }
        parts.first.push_back(parts.triangles.size());
        result.flat_areas.push_back(area);
    }
    return parts;
}

}  // namespace

Charts find_charts(const LitSurface& surface, double spacing) {
    Charts result;
    result.neighbours = find_neighbours(surface);
    const FlatParts parts = find_flat_parts(surface, result.neighbours, result);
    const std::vector<V3f> smooth = smooth_normals(surface, result.neighbours, spacing);
    result.chart_of.assign(surface.triangles.size(), none);

    std::vector<std::uint32_t> members;  // flat parts of the chart that grows
    for (const std::uint32_t seed :
         by_area(result.flat_areas.size(), [&](std::uint32_t flat) { return result.flat_areas[flat]; })) {
        if (result.chart_of[parts.of(seed)[0]] != none) continue;
        const auto number = static_cast<std::uint32_t>(result.charts.size());
        const std::uint32_t first = parts.of(seed)[0];
        const V3f& own = surface.triangles[first].normal;
        const V3f normal = own.dot(smooth[first]) >= chart_cosine ? smooth[first] : own;
        float min_cosine = 1;
        const auto take = [&](std::uint32_t flat) {
            members.push_back(flat);
            for (const std::uint32_t t : parts.of(flat)) {
                result.chart_of[t] = number;
                min_cosine = std::min(min_cosine, surface.triangles[t].normal.dot(normal));
            }
        };
        const auto fits = [&](std::uint32_t flat) {
            const std::uint32_t t = parts.of(flat)[0];
            return smooth[t].dot(normal) >= chart_cosine && surface.triangles[t].normal.dot(normal) >= steepest_cosine;
        };
        members.clear();
        take(seed);
        for (std::size_t next = 0; next < members.size(); ++next)
            for (const std::uint32_t t : parts.of(members[next]))
                for (const std::uint32_t other : result.neighbours[t])
                    if (other != none && result.chart_of[other] == none && fits(result.flat_of[other]))
                        take(result.flat_of[other]);
        result.charts.push_back({.normal = V3d(normal), .min_cosine = min_cosine});
    }
    return result;
}

}  // namespace vmap
