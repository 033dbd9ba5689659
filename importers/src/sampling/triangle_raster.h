// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Which unit cells of a plane a triangle touches, and which places are inside it.
#pragma once

#include <Imath/ImathVec.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace vmap {

/// A triangle in the plane. Of triangles that share edges, exactly one contains a place that lies on the edge: an edge
/// is evaluated from the same end whichever triangle asks.
class PlaneTriangle {
public:
    explicit PlaneTriangle(const std::array<Imath::V2d, 3>& corners) : corners_(corners) {
        const bool is_clockwise = cross(corners[1] - corners[0], corners[2] - corners[0]) < 0;
        for (int k = 0; k < 3; ++k) {
            Edge& edge = edges_[k];
            edge.from = corners[k];
            edge.to = corners[(k + 1) % 3];
            edge.is_left = !is_clockwise;
            if (std::pair(edge.to.x, edge.to.y) < std::pair(edge.from.x, edge.from.y)) {
                std::swap(edge.from, edge.to);
                edge.is_left = !edge.is_left;
            }
        }
    }

    [[nodiscard]] bool contains(const Imath::V2d& place) const {
        for (const Edge& edge : edges_) {
            const double side = cross(edge.to - edge.from, place - edge.from);
            if (edge.is_left ? side < 0 : side >= 0) return false;
        }
        return true;
    }

    /// Weights of the second and third corner; not clamped.
    [[nodiscard]] Imath::V2d weights(const Imath::V2d& place) const {
        const Imath::V2d ab = corners_[1] - corners_[0];
        const Imath::V2d ac = corners_[2] - corners_[0];
        const Imath::V2d ap = place - corners_[0];
        const double whole = cross(ab, ac);
        return {cross(ap, ac) / whole, cross(ab, ap) / whole};
    }

    /// Rows of cells that it touches: first, and one past the last.
    [[nodiscard]] std::pair<std::int64_t, std::int64_t> rows() const {
        const auto [low, high] = std::minmax({corners_[0].y, corners_[1].y, corners_[2].y});
        return {floor(low), floor(high) + 1};
    }

    /// Cells of one row that it touches: first, and one past the last; empty when there are none.
    [[nodiscard]] std::pair<std::int64_t, std::int64_t> cells(std::int64_t row) const {
        const auto bottom = static_cast<double>(row);
        double low = std::numeric_limits<double>::max();
        double high = -low;
        for (int k = 0; k < 3; ++k) {
            const Imath::V2d& a = corners_[k];
            const Imath::V2d& b = corners_[(k + 1) % 3];
            if (std::max(a.y, b.y) < bottom || std::min(a.y, b.y) > bottom + 1) continue;
            for (const double x : {x_at(a, b, bottom), x_at(a, b, bottom + 1)}) {
                low = std::min(low, x);
                high = std::max(high, x);
            }
        }
        if (low > high) return {0, 0};
        return {floor(low), floor(high) + 1};
    }

private:
    struct Edge {
        Imath::V2d from;
        Imath::V2d to;
        bool is_left = true;  ///< the inside is on the left, the edge included
    };

    static double cross(const Imath::V2d& a, const Imath::V2d& b) { return a.x * b.y - a.y * b.x; }
    static std::int64_t floor(double x) { return static_cast<std::int64_t>(std::floor(x)); }

    /// Where the edge is at height y, or its end that is nearest to it.
    static double x_at(const Imath::V2d& a, const Imath::V2d& b, double y) {
        if (a.y == b.y) return y <= a.y ? a.x : b.x;
        return a.x + (b.x - a.x) * std::clamp((y - a.y) / (b.y - a.y), 0.0, 1.0);
    }

    std::array<Imath::V2d, 3> corners_;
    std::array<Edge, 3> edges_;
};

}  // namespace vmap
