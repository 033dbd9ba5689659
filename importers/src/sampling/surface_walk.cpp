// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface_walk.h"

#include <algorithm>
#include <array>

namespace vmap {
namespace {

using Imath::V2d;
using Imath::V3d;

/// A triangle as a frame: first corner and the edges to the other two.
struct TriangleFrame {
    V3d corner;
    V3d to_second;
    V3d to_third;

    TriangleFrame(const LitSurface& surface, std::uint32_t triangle) {
        const auto [a, b, c] = surface.corners(surface.triangles[triangle]);
        corner = a;
        to_second = b - a;
        to_third = c - a;
    }
    [[nodiscard]] V3d at(const V3d& weights) const { return corner + to_second * weights.y + to_third * weights.z; }

    /// The part of a vector in the plane, in the two edges.
    [[nodiscard]] V2d along(const V3d& v) const {
        const double bb = to_second.length2();
        const double bc = to_second.dot(to_third);
        const double cc = to_third.length2();
        const double vb = v.dot(to_second);
        const double vc = v.dot(to_third);
        const double whole = bb * cc - bc * bc;
        return whole > 0 ? V2d((vb * cc - vc * bc) / whole, (vc * bb - vb * bc) / whole) : V2d(0, 0);
    }
    [[nodiscard]] V3d in_world(const V2d& v) const { return to_second * v.x + to_third * v.y; }

    /// Along the edge opposite to a corner, unit.
    [[nodiscard]] V3d edge_opposite(int corner_number) const {
        const std::array<V3d, 3> edges{to_third - to_second, to_third, to_second};
        return edges[corner_number].normalized();
    }
};

/// Weights of all three corners.
V3d weights_of(const V2d& uv) {
    return {1 - uv.x - uv.y, uv.x, uv.y};
}

V3d clamped(const V3d& weights) {
    const V3d positive(std::max(weights.x, 0.0), std::max(weights.y, 0.0), std::max(weights.z, 0.0));
    return positive / (positive.x + positive.y + positive.z);
}

}  // namespace

WalkEnd walk(const LitSurface& surface, const Neighbours& neighbours, std::span<const std::uint32_t> pools,
             const PlacedPoint& from, const V3d& step) {
    constexpr int most_edges = 64;
    std::uint32_t triangle = from.triangle;
    V3d weights = weights_of(V2d(from.u, from.v) * PlacedPoint::unit);
    TriangleFrame frame(surface, triangle);
    V3d left = frame.in_world(frame.along(step));
    for (int edge = 0; edge < most_edges; ++edge) {
        const V2d uv = frame.along(left);
        const V3d change(-uv.x - uv.y, uv.x, uv.y);
        double share = 1;
        int across = -1;  // the corner that the edge to be crossed is opposite to
        for (int k = 0; k < 3; ++k) {
            if (change[k] >= 0 || weights[k] + change[k] >= 0) continue;
            const double here = std::max(weights[k], 0.0) / -change[k];
            if (here > share) continue;
            share = here;
            across = k;
        }
        weights = clamped(weights + change * share);
        if (across < 0) break;

        left *= 1 - share;
        const std::uint32_t next = neighbours[triangle][(across + 1) % 3];
        if (next == no_neighbour || pools[next] != pools[triangle]) {
            const V3d wall = frame.edge_opposite(across);
            left = wall * (2 * left.dot(wall)) - left;
            continue;
        }
        const V3d place = frame.at(weights);
        const double length = left.length();
        triangle = next;
        frame = TriangleFrame(surface, triangle);
        weights = clamped(weights_of(frame.along(place - frame.corner)));
        left = frame.in_world(frame.along(left));
        const double kept = left.length();
        if (!(kept > 0)) break;
        left *= length / kept;
    }
    return {placed_point(triangle, V2d(weights.y, weights.z)), frame.at(weights)};
}

}  // namespace vmap
