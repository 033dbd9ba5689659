// SPDX-License-Identifier: GPL-3.0-or-later
#include "triangulate.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace vmap {
namespace {

using Imath::V2d;
using Imath::V3d;
using Triangle = std::array<std::uint32_t, 3>;

/// Twice the polygon's area along its mean normal. Relative to one corner, so that it is exact far from the origin too.
V3d newell_normal(std::span<const V3d> corners) {
    V3d sum(0, 0, 0);
    for (std::size_t i = 2; i < corners.size(); ++i)
        sum += (corners[i - 1] - corners[0]).cross(corners[i] - corners[0]);
    return sum;
}

/// The polygon seen from the side to which its normal points most, relative to its first corner: counter-clockwise.
std::vector<V2d> flatten(std::span<const V3d> corners, const V3d& normal) {
    const V3d size(std::abs(normal.x), std::abs(normal.y), std::abs(normal.z));
    const int drop = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    int u = (drop + 1) % 3;
    int v = (drop + 2) % 3;
    if (normal[drop] < 0) std::swap(u, v);
    std::vector<V2d> flat;
    flat.reserve(corners.size());
    for (const V3d& corner : corners) flat.emplace_back(corner[u] - corners[0][u], corner[v] - corners[0][v]);
    return flat;
}

/// Positive where a, b, c run counter-clockwise.
double turn(const V2d& a, const V2d& b, const V2d& c) {
    return (b - a).cross(c - a);
}

/// Cuts ears off a polygon until nothing is left.
class EarClipper {
public:
    explicit EarClipper(std::vector<V2d> corners)
        : corners_(std::move(corners)), next_(corners_.size()), previous_(corners_.size()) {
        const std::size_t count = corners_.size();
        for (std::size_t i = 0; i < count; ++i) {
            next_[i] = static_cast<std::uint32_t>((i + 1) % count);
            previous_[i] = static_cast<std::uint32_t>((i + count - 1) % count);
        }
    }

    bool clip(std::vector<Triangle>& triangles) {
        bool clean = true;
        std::uint32_t candidate = 0;
        std::size_t refused = 0;
        for (std::size_t left = corners_.size(); left > 3;) {
            if (!is_ear(candidate)) {
                if (++refused < left && tests_ < most_tests) {
                    candidate = next_[candidate];
                    continue;
                }
                clean = false;
            }
            triangles.push_back({previous_[candidate], candidate, next_[candidate]});
            next_[previous_[candidate]] = next_[candidate];
            previous_[next_[candidate]] = previous_[candidate];
            // Going on at the second next spreads the cuts instead of fanning out slivers.
            candidate = next_[next_[candidate]];
            refused = 0;
            --left;
        }
        triangles.push_back({previous_[candidate], candidate, next_[candidate]});
        return clean;
    }

private:
    /// A convex corner whose triangle holds no other corner. A flat one goes first: its triangle has no area.
    bool is_ear(std::uint32_t corner) {
        const V2d& a = corners_[previous_[corner]];
        const V2d& b = corners_[corner];
        const V2d& c = corners_[next_[corner]];
        const double area = turn(a, b, c);
        if (area < 0) return false;
        if (area == 0) return (b - a).dot(c - b) >= 0 || a == c;
        for (std::uint32_t i = next_[next_[corner]]; i != previous_[corner]; i = next_[i]) {
            ++tests_;
            const V2d& p = corners_[i];
            if (p == a || p == b || p == c) continue;
            if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
        }
        return true;
    }

    /// Huge polygons that cross themselves are cut anyhow once this is used up.
    static constexpr std::size_t most_tests = 100'000'000;

    std::vector<V2d> corners_;
    std::vector<std::uint32_t> next_;
    std::vector<std::uint32_t> previous_;
    std::size_t tests_ = 0;
};

/// Whether all triangles from one corner turn as the polygon does; then they cover it.
bool is_fan(std::span<const V2d> corners, std::size_t from) {
    const std::size_t count = corners.size();
    for (std::size_t i = 1; i + 1 < count; ++i)
        if (turn(corners[from], corners[(from + i) % count], corners[(from + i + 1) % count]) < 0) return false;
    return true;
}

void add_fan(std::size_t count, std::size_t from, std::vector<Triangle>& triangles) {
    const auto corner = [&](std::size_t i) { return static_cast<std::uint32_t>((from + i) % count); };
    for (std::size_t i = 1; i + 1 < count; ++i) triangles.push_back({corner(0), corner(i), corner(i + 1)});
}

}  // namespace

bool triangulate_polygon(std::span<const V3d> corners, std::vector<Triangle>& triangles) {
    if (corners.size() == 3) {
        triangles.push_back({0, 1, 2});
        return true;
    }
    std::vector<V2d> flat = flatten(corners, newell_normal(corners));
    const std::size_t starts = corners.size() == 4 ? 2 : 1;
    for (std::size_t from = 0; from < starts; ++from) {
        if (!is_fan(flat, from)) continue;
        add_fan(corners.size(), from, triangles);
        return true;
    }
    return EarClipper(std::move(flat)).clip(triangles);
}

}  // namespace vmap
