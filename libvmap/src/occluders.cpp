// SPDX-License-Identifier: Apache-2.0
#include "occluders.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace vmap {
namespace {

constexpr std::uint32_t least_wall_discs = 6;  ///< fewer are tested one by one
constexpr double cell_per_radius = 0.15;       ///< edge of a cell, in radii of the plane's median disc
constexpr double most_cells_per_disc = 256;

/// Where rounding could decide: no cell is called covered or empty that is so by less.
constexpr double margin = 2e-6;

PlaneRectangle bounds_of(std::span<const LeafDisc> discs) {
    PlaneRectangle bounds{1e30F, -1e30F, 1e30F, -1e30F};
    for (const LeafDisc& disc : discs) {
        const float radius = std::sqrt(disc.radius_squared) * 1.00001F + static_cast<float>(margin);
        bounds.u_min = std::min(bounds.u_min, disc.u - radius);
        bounds.u_max = std::max(bounds.u_max, disc.u + radius);
        bounds.v_min = std::min(bounds.v_min, disc.v - radius);
        bounds.v_max = std::max(bounds.v_max, disc.v + radius);
    }
    return bounds;
}

double median_radius(std::span<const LeafDisc> discs) {
    std::vector<float> squares;
    for (const LeafDisc& disc : discs) squares.push_back(disc.radius_squared);
    const auto middle = squares.begin() + std::ssize(squares) / 2;
    std::ranges::nth_element(squares, middle);
    return std::sqrt(static_cast<double>(*middle));
}

}  // namespace

PlaneRaster::PlaneRaster(std::span<const LeafDisc> discs, const PlaneRectangle& bounds) {
    const double width = static_cast<double>(bounds.u_max) - static_cast<double>(bounds.u_min);
    const double height = static_cast<double>(bounds.v_max) - static_cast<double>(bounds.v_min);
    const double least = std::sqrt(width * height / (most_cells_per_disc * static_cast<double>(discs.size())));
    const double edge = std::max({cell_per_radius * median_radius(discs), least, 1e-3 * std::max(width, height)});
    per_unit_ = static_cast<float>(1 / edge);
    u_min_ = bounds.u_min;
    v_min_ = bounds.v_min;
    columns_ = static_cast<int>(std::ceil(width / edge)) + 1;
    rows_ = static_cast<int>(std::ceil(height / edge)) + 1;
    classify(discs);
    sum_up();
}

void PlaneRaster::classify(std::span<const LeafDisc> discs) {
    const std::size_t count = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
    cells_.assign(count + 3, static_cast<std::uint8_t>(Cell::empty));
    first_disc_.assign(count + 1, 0);
    const double edge = 1 / static_cast<double>(per_unit_);

    // Calls visit(cell, covered) for every cell that a disc meets.
    const auto for_cells = [&](const LeafDisc& disc, const auto& visit) {
        const double radius = std::sqrt(static_cast<double>(disc.radius_squared));
        const double inner = std::max(0.0, radius - margin);
        const double outer = radius + margin;
        const double u = static_cast<double>(disc.u) - static_cast<double>(u_min_);
        const double v = static_cast<double>(disc.v) - static_cast<double>(v_min_);
        const auto index = [&](double x, int last) { return std::clamp(static_cast<int>(x / edge), 0, last); };
        for (int row = index(v - outer, rows_ - 1); row <= index(v + outer, rows_ - 1); ++row)
            for (int column = index(u - outer, columns_ - 1); column <= index(u + outer, columns_ - 1); ++column) {
                // Distances of the cell's nearest and farthest place; cells are a little larger than they are, so that
                // the rounding of a place's cell does not matter.
                const double u_low = column * edge - margin - u;
                const double v_low = row * edge - margin - v;
                const double u_high = u_low + edge + 2 * margin;
                const double v_high = v_low + edge + 2 * margin;
                const double near_u = std::max({u_low, -u_high, 0.0});
                const double near_v = std::max({v_low, -v_high, 0.0});
                const double far_u = std::max(-u_low, u_high);
                const double far_v = std::max(-v_low, v_high);
                if (near_u * near_u + near_v * near_v >= outer * outer) continue;
                visit(static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                          static_cast<std::size_t>(column),
                      far_u * far_u + far_v * far_v < inner * inner);
            }
    };

    constexpr auto covered = static_cast<std::uint8_t>(Cell::covered);
    for (const LeafDisc& disc : discs)
        for_cells(disc, [&](std::size_t cell, bool whole) {
            if (whole) cells_[cell] = covered;
        });
    for (const LeafDisc& disc : discs)
        for_cells(disc, [&](std::size_t cell, bool) {
            if (cells_[cell] == covered) return;
            cells_[cell] = static_cast<std::uint8_t>(Cell::mixed);
            ++first_disc_[cell + 1];
        });
    for (std::size_t cell = 0; cell < count; ++cell) first_disc_[cell + 1] += first_disc_[cell];
    cell_discs_.resize(first_disc_[count]);
    std::vector<std::uint32_t> next(first_disc_.begin(), first_disc_.end() - 1);
    for (const LeafDisc& disc : discs)
        for_cells(disc, [&](std::size_t cell, bool) {
            if (cells_[cell] != covered) cell_discs_[next[cell]++] = disc;
        });
}

void PlaneRaster::sum_up() {
    const auto stride = static_cast<std::size_t>(columns_) + 1;
    touched_.assign(stride * (static_cast<std::size_t>(rows_) + 1), 0);
    uncovered_ = touched_;
    for (std::size_t row = 0; row < static_cast<std::size_t>(rows_); ++row)
        for (std::size_t column = 0; column < static_cast<std::size_t>(columns_); ++column) {
            const auto cell = static_cast<Cell>(cells_[row * static_cast<std::size_t>(columns_) + column]);
            const std::size_t at = (row + 1) * stride + column + 1;
            const auto add = [&](std::vector<std::uint32_t>& sums, bool counts) {
                sums[at] = sums[at - 1] + sums[at - stride] - sums[at - stride - 1] + (counts ? 1 : 0);
            };
            add(touched_, cell != Cell::empty);
            add(uncovered_, cell != Cell::covered);
        }
}

PlaneRaster::Cell PlaneRaster::look_up(const PlaneRectangle& rectangle) const {
    const float slack = 2e-6F * per_unit_;
    const float left = (rectangle.u_min - u_min_) * per_unit_ - slack;
    const float right = (rectangle.u_max - u_min_) * per_unit_ + slack;
    const float bottom = (rectangle.v_min - v_min_) * per_unit_ - slack;
    const float top = (rectangle.v_max - v_min_) * per_unit_ + slack;
    const auto width = static_cast<float>(columns_);
    const auto height = static_cast<float>(rows_);
    if (right < 0 || left >= width || top < 0 || bottom >= height) return Cell::empty;

    const auto x0 = static_cast<std::size_t>(std::max(left, 0.0F));
    const auto y0 = static_cast<std::size_t>(std::max(bottom, 0.0F));
    const std::size_t x1 = static_cast<std::size_t>(std::min(right, width - 1)) + 1;
    const std::size_t y1 = static_cast<std::size_t>(std::min(top, height - 1)) + 1;
    const auto stride = static_cast<std::size_t>(columns_) + 1;
    const auto sum = [&](const std::vector<std::uint32_t>& sums) {
        return sums[y1 * stride + x1] - sums[y0 * stride + x1] - sums[y1 * stride + x0] + sums[y0 * stride + x0];
    };
    if (sum(touched_) == 0) return Cell::empty;
    const bool sticks_out = left < 0 || right >= width || bottom < 0 || top >= height;
    return !sticks_out && sum(uncovered_) == 0 ? Cell::covered : Cell::mixed;
}

Occluders::Occluders(const LeafVisibility& visibility) {
    const auto planes = visibility.planes();
    const auto all_discs = visibility.discs();
    std::vector<std::uint32_t> count(planes.size());
    for (const LeafDisc& disc : all_discs) ++count[disc.plane];

    // On a uniform tree a disc blocks some segments only, so that each is looked at on its own.
    const auto is_in_wall = [&](const LeafDisc& disc) {
        return !visibility.walks_cells() && count[disc.plane] >= least_wall_discs && std::isfinite(disc.radius_squared);
    };
    std::vector<std::vector<LeafDisc>> of_plane(planes.size());
    for (std::uint32_t leaf = 0; leaf < all_discs.size(); ++leaf) {
        const LeafDisc& disc = all_discs[leaf];
        if (is_in_wall(disc))
            of_plane[disc.plane].push_back(disc);
        else
            discs.push_back({planes[disc.plane], disc, leaf});
    }

    std::vector<std::uint32_t> wall_planes;
    for (std::uint32_t p = 0; p < planes.size(); ++p)
        if (!of_plane[p].empty()) wall_planes.push_back(p);
    walls.resize(wall_planes.size());
    tbb::parallel_for(std::size_t{0}, walls.size(), [&](std::size_t w) {
        const std::vector<LeafDisc>& in_plane = of_plane[wall_planes[w]];
        const PlaneRectangle bounds = bounds_of(in_plane);
        walls[w] = {planes[wall_planes[w]], bounds, PlaneRaster(in_plane, bounds)};
    });
}

}  // namespace vmap
