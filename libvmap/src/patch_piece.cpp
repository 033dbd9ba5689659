// SPDX-License-Identifier: Apache-2.0
#include "patch_piece.h"

#include <cmath>

namespace vmap {

using Imath::V2d;
using Imath::V3d;
using Imath::V3f;

double area_of(const PointCloud& cloud, std::span<const std::uint32_t> points) {
    double area = 0;
    for (const std::uint32_t i : points) area += static_cast<double>(cloud.areas[i]);
    return area;
}

V3d any_perpendicular(const V3d& n) {
    return n.cross(std::abs(n.x) < 0.6 ? V3d(1, 0, 0) : V3d(0, 1, 0)).normalized();
}

Patch make_patch(const V3d& center, const V3d& normal, const V3d& u, double area, bool flat) {
    Patch patch;
    patch.center = V3f(center);
    patch.normal = V3f(normal);
    patch.u = V3f(u);
    patch.v = V3f(normal.cross(u));
    patch.area = static_cast<float>(area);
    patch.flat = flat;
    return patch;
}

std::vector<V2d> project(const PointCloud& cloud, std::span<const std::uint32_t> points, const Patch& patch) {
    std::vector<V2d> flat(points.size());
    const V3d center(patch.center);
    const V3d u(patch.u);
    const V3d v(patch.v);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const V3d p = V3d(cloud.positions[points[i]]) - center;
        flat[i] = {p.dot(u), p.dot(v)};
    }
    return flat;
}

std::vector<Edge> edges_of(const std::vector<V2d>& outline) {
    std::vector<Edge> edges;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const V2d along = (outline[(i + 1) % outline.size()] - outline[i]).normalized();
        const V2d inward(-along.y, along.x);
        edges.push_back({inward, inward.dot(outline[i])});
    }
    return edges;
}

std::vector<V2d> outline_of(const std::vector<Edge>& edges) {
    std::vector<V2d> outline;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const Edge& a = edges[(i + edges.size() - 1) % edges.size()];
        const Edge& b = edges[i];
        const double turn = a.inward.x * b.inward.y - a.inward.y * b.inward.x;
        if (turn < 1e-3) return {};
        outline.emplace_back((a.offset * b.inward.y - b.offset * a.inward.y) / turn,
                             (b.offset * a.inward.x - a.offset * b.inward.x) / turn);
    }
    return outline;
}

PolygonSet outlines_of(std::span<const Piece> pieces) {
    PolygonSet outlines;
    std::vector<V3f> vertices;
    for (const Piece& piece : pieces) {
        vertices.clear();
        for (const V2d& q : piece.outline)
            vertices.emplace_back(V3d(piece.patch.center) + V3d(piece.patch.u) * q.x + V3d(piece.patch.v) * q.y);
        outlines.add(vertices);
    }
    return outlines;
}

}  // namespace vmap
