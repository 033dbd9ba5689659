// SPDX-License-Identifier: GPL-3.0-or-later
#include "triangle_neighbours.h"

#include "welded_mesh.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <numeric>
#include <utility>

namespace vmap {
namespace {

using Imath::V3f;

constexpr float small_smooth_cosine = 0.2F;
constexpr float flat_cosine = 0.99996F;  ///< half a degree

/// Edges as the lit side sees them, so that front and back of one face run opposite ways.
std::vector<TriangleEdge> edges_of(const LitSurface& surface) {
    const WeldedVertices vertices(*surface.scene, surface.origin);
    std::vector<TriangleEdge> edges(3 * surface.triangles.size());
    tbb::parallel_for(std::size_t{0}, surface.triangles.size(), [&](std::size_t t) {
        const LitTriangle& triangle = surface.triangles[t];
        const std::size_t instance = triangle.instance;
        auto numbers = vertices.of(instance, triangle.face - surface.first_faces[instance]);
        const bool is_turned = is_mirrored(surface.scene->instances[instance]) != triangle.is_back();
        if (is_turned) std::swap(numbers[1], numbers[2]);
        for (int k = 0; k < 3; ++k)
            edges[3 * t + k] =
                triangle_edge(static_cast<std::uint32_t>(t), is_turned ? 2 - k : k, numbers[k], numbers[(k + 1) % 3]);
    });
    tbb::parallel_sort(edges);
    return edges;
}

}  // namespace

Neighbours find_neighbours(const LitSurface& surface, double spacing) {
    constexpr std::size_t knot = 64;  // faces at one edge: nothing can be said there
    const std::vector<TriangleEdge> edges = edges_of(surface);
    const std::vector<LitTriangle>& triangles = surface.triangles;
    Neighbours neighbours(triangles.size(), {no_neighbour, no_neighbour, no_neighbour});
    for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
        for (end = begin; end < edges.size() && edges[end].vertices == edges[begin].vertices;) ++end;
        if (end - begin > knot) continue;
        for (std::size_t k = begin; k < end; ++k) {
            const LitTriangle& here = triangles[edges[k].triangle];
            float best = -1;
            for (std::size_t other = begin; other < end; ++other) {
                const LitTriangle& there = triangles[edges[other].triangle];
                if (edges[other].is_ascending == edges[k].is_ascending || there.face == here.face) continue;
                const bool are_small = std::max(here.area, there.area) < small_part * spacing * spacing;
                const float cosine = here.normal.dot(there.normal);
                if (cosine <= std::max(best, are_small ? small_smooth_cosine : smooth_cosine)) continue;
                best = cosine;
                neighbours[edges[k].triangle][edges[k].corner] = edges[other].triangle;
            }
        }
    }
    return neighbours;
}

std::vector<std::uint32_t> by_area(std::span<const double> areas) {
    std::vector<std::uint32_t> order(areas.size());
    std::iota(order.begin(), order.end(), 0U);
    tbb::parallel_sort(
        order, [&](std::uint32_t a, std::uint32_t b) { return areas[a] != areas[b] ? areas[a] > areas[b] : a < b; });
    return order;
}

FlatParts find_flat_parts(const LitSurface& surface, const Neighbours& neighbours) {
    std::vector<double> areas(surface.triangles.size());
    for (std::size_t t = 0; t < areas.size(); ++t) areas[t] = surface.triangles[t].area;
    FlatParts parts;
    parts.of.assign(areas.size(), no_neighbour);
    for (const std::uint32_t seed : by_area(areas)) {
        if (parts.of[seed] != no_neighbour) continue;
        const std::uint32_t number = parts.size();
        const V3f& normal = surface.triangles[seed].normal;
        double area = 0;
        parts.of[seed] = number;
        parts.triangles.push_back(seed);
        for (std::size_t next = parts.first.back(); next < parts.triangles.size(); ++next) {
            area += areas[parts.triangles[next]];
            for (const std::uint32_t other : neighbours[parts.triangles[next]]) {
                if (other == no_neighbour || parts.of[other] != no_neighbour) continue;
                if (surface.triangles[other].normal.dot(normal) < flat_cosine) continue;
                parts.of[other] = number;
                parts.triangles.push_back(other);
            }
        }
        parts.first.push_back(parts.triangles.size());
        parts.areas.push_back(area);
    }
    return parts;
}

std::vector<V3f> smooth_normals(const LitSurface& surface, const Neighbours& neighbours, const FlatParts& flats,
                                double spacing) {
    constexpr int rounds = 4;
    std::vector<V3f> normals(surface.triangles.size());
    for (std::size_t t = 0; t < normals.size(); ++t) normals[t] = surface.triangles[t].normal;
    std::vector<V3f> next = normals;
    const auto average = [&](std::uint32_t t) {
        if (flats.areas[flats.of[t]] >= small_part * spacing * spacing) return;
        V3f sum = normals[t] * static_cast<float>(surface.triangles[t].area / (spacing * spacing));
        for (const std::uint32_t other : neighbours[t])
            if (other != no_neighbour)
                sum += normals[other] * static_cast<float>(surface.triangles[other].area / (spacing * spacing));
        const float length = sum.length();
        if (length > 0) next[t] = sum / length;
    };
    for (int round = 0; round < rounds; ++round) {
        tbb::parallel_for(std::uint32_t{0}, static_cast<std::uint32_t>(normals.size()), average);
        normals.swap(next);
    }
    return normals;
}

}  // namespace vmap
