// SPDX-License-Identifier: GPL-3.0-or-later
#include "stratified.h"

#include "random_numbers.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

namespace vmap {
namespace {

using Imath::V2d;
using Imath::V3d;

/// Where in its piece, at `number` on the line, a point falls. Twenty bits keep the sum exact.
double place_on_line(std::uint64_t seed, std::size_t number) {
    return static_cast<double>(number) + static_cast<double>(hash_bits(seed, 2 * number) >> 44) * 0x1p-20;
}

/// Evenly at random in a triangle: weights of its second and third vertex.
V2d in_triangle(std::uint64_t hash) {
    const double s = upper_unit(hash);
    const double t = lower_unit(hash);
    return s + t > 1 ? V2d(1 - s, 1 - t) : V2d(s, t);
}

/// A part of a triangle and the stretch of the line that is folded into it.
struct Piece {
    std::array<V2d, 3> corners;     ///< weights of the triangle's second and third vertex
    std::array<double, 3> squares;  ///< of the length of the edge opposite to each corner
    double begin = 0;
    double end = 0;

    /// Cuts the longest edge in the middle.
    [[nodiscard]] std::pair<Piece, Piece> halves() const {
        const auto longest = std::ranges::max_element(squares) - squares.begin();
        const auto p = (longest + 1) % 3;
        const auto q = (longest + 2) % 3;
        const V2d middle = (corners[p] + corners[q]) * 0.5;
        const double across = (2 * squares[p] + 2 * squares[q] - squares[longest]) / 4;
        const double half = squares[longest] / 4;
        const double center = (begin + end) / 2;
        return {{{corners[longest], corners[p], middle}, {half, across, squares[q]}, begin, center},
                {{corners[longest], middle, corners[q]}, {half, squares[p], across}, center, end}};
    }
};

/// Fills the points of some pieces of the line.
class Filler {
public:
    Filler(std::uint64_t seed, std::size_t first, std::size_t last, std::span<PlacedPoint> points)
        : seed_(seed), first_(first), last_(last), points_(points) {}

    void fill(std::uint32_t triangle, const Piece& piece) {
        constexpr double small = 1.0 / 16;  // of a piece of the line: below it a point falls anywhere
        const auto begin = std::max(static_cast<std::size_t>(piece.begin), first_);
        const auto end = std::min(static_cast<std::size_t>(std::ceil(piece.end)), last_);
        if (piece.end - piece.begin > small) {
            if (begin + 2 >= end && !has_point(piece, begin, end)) return;
            const auto [one, other] = piece.halves();
            fill(triangle, one);
            fill(triangle, other);
            return;
        }
        for (std::size_t number = begin; number < end; ++number)
            if (is_in(piece, number)) points_[number] = point_in(triangle, piece, number);
    }

private:
    [[nodiscard]] bool is_in(const Piece& piece, std::size_t number) const {
        const double place = place_on_line(seed_, number);
        return place >= piece.begin && place < piece.end;
    }
    [[nodiscard]] bool has_point(const Piece& piece, std::size_t begin, std::size_t end) const {
        for (std::size_t number = begin; number < end; ++number)
            if (is_in(piece, number)) return true;
        return false;
    }
    [[nodiscard]] PlacedPoint point_in(std::uint32_t triangle, const Piece& piece, std::size_t number) const {
        const std::uint64_t hash = hash_bits(seed_, 2 * number + 1);
        const V2d st = in_triangle(hash);
        const auto& [a, b, c] = piece.corners;
        return placed_point(triangle, a + (b - a) * st.x + (c - a) * st.y);
    }

    std::uint64_t seed_;
    std::size_t first_;
    std::size_t last_;
    std::span<PlacedPoint> points_;
};

Piece whole_triangle(const LitSurface& surface, const LitTriangle& triangle, double begin, double end) {
    const auto [a, b, c] = surface.corners(triangle);
    return {{V2d(0, 0), V2d(1, 0), V2d(0, 1)}, {(c - b).length2(), (a - c).length2(), (b - a).length2()}, begin, end};
}

/// Every third bit of the result is one of the 21 bits of x.
std::uint64_t spread_bits(std::uint64_t x) {
    x = (x | x << 32) & 0x1F00000000FFFFULL;
    x = (x | x << 16) & 0x1F0000FF0000FFULL;
    x = (x | x << 8) & 0x100F00F00F00F00FULL;
    x = (x | x << 4) & 0x10C30C30C30C30C3ULL;
    return (x | x << 2) & 0x1249249249249249ULL;
}

}  // namespace

void place_stratified(const LitSurface& surface, std::span<const std::uint32_t> triangles, std::uint64_t seed,
                      std::span<PlacedPoint> points) {
    std::vector<double> ends(triangles.size());
    double area = 0;
    for (std::size_t i = 0; i < triangles.size(); ++i) ends[i] = area += surface.triangles[triangles[i]].area;
    const auto count = static_cast<double>(points.size());
    for (double& end : ends) end = std::min(end / area, 1.0) * count;
    if (!ends.empty()) ends.back() = count;

    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size(), 4096), [&](const auto& range) {
        Filler filler(seed, range.begin(), range.end(), points);
        const double first = static_cast<double>(range.begin());
        for (std::size_t i = std::ranges::upper_bound(ends, first) - ends.begin(); i < ends.size(); ++i) {
            const double begin = i == 0 ? 0 : ends[i - 1];
            if (begin >= static_cast<double>(range.end())) break;
            filler.fill(triangles[i], whole_triangle(surface, surface.triangles[triangles[i]], begin, ends[i]));
        }
    });
}

Placement place_stratified(const LitSurface& surface, const SurfaceShading& shading,
                           std::span<const std::size_t> counts, std::uint64_t seed) {
    std::vector<std::vector<std::uint32_t>> triangles(counts.size());
    std::vector<double> areas(counts.size(), 0);
    for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
        const LitTriangle& triangle = surface.triangles[t];
        triangles[triangle.surface].push_back(t);
        areas[triangle.surface] += triangle.area;
    }
    Placement placement;
    placement.points.resize(std::accumulate(counts.begin(), counts.end(), std::size_t{0}));
    placement.areas.resize(placement.points.size());
    std::size_t first = 0;
    for (std::size_t s = 0; s < counts.size(); ++s) {
        if (counts[s] == 0) continue;
        const std::span<PlacedPoint> points = std::span(placement.points).subspan(first, counts[s]);
        sort_by_place(surface, triangles[s]);
        place_stratified(surface, triangles[s], hash_bits(seed, s), points);
        move_off_cuts(surface, shading, hash_bits(seed, s), points);
        std::fill_n(placement.areas.begin() + static_cast<std::ptrdiff_t>(first), counts[s],
                    static_cast<float>(areas[s] / static_cast<double>(counts[s])));
        first += counts[s];
    }
    return placement;
}

void move_off_cuts(const LitSurface& surface, const SurfaceShading& shading, std::uint64_t seed,
                   std::span<PlacedPoint> points) {
    constexpr std::uint64_t tries = 100'000;  // a triangle that has some area left was seen in far fewer looks
    tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
        const LitTriangle& triangle = surface.triangles[points[i].triangle];
        if (!surface.is_masked(triangle)) return;
        const auto is_cut = [&](const PlacedPoint& p) {
            return shading.is_cut(surface.place(triangle, p.u * PlacedPoint::unit, p.v * PlacedPoint::unit, 0));
        };
        for (std::uint64_t k = 0; k < tries && is_cut(points[i]); ++k)
            points[i] = placed_point(points[i].triangle, in_triangle(hash_bits(seed ^ hash_bits(i), k)));
    });
}

std::uint64_t place_on_curve(const LitSurface& surface, std::uint32_t triangle) {
    const double scale = 0x1p20 / std::max(surface.extent, 1e-300);
    const auto [a, b, c] = surface.corners(surface.triangles[triangle]);
    const V3d middle = (a + b + c) * (scale / 3) + V3d(0x1p20);
    std::uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis)
        key |= spread_bits(static_cast<std::uint64_t>(std::clamp(middle[axis], 0.0, 0x1p21 - 1))) << axis;
    return key;
}

void sort_by_place(const LitSurface& surface, std::span<std::uint32_t> triangles) {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keyed(triangles.size());
    tbb::parallel_for(std::size_t{0}, triangles.size(),
                      [&](std::size_t i) { keyed[i] = {place_on_curve(surface, triangles[i]), triangles[i]}; });
    tbb::parallel_sort(keyed);
    for (std::size_t i = 0; i < triangles.size(); ++i) triangles[i] = keyed[i].second;
}

}  // namespace vmap
