// SPDX-License-Identifier: Apache-2.0
#include "patch_points.h"

#include <Imath/ImathBox.h>

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vmap {
namespace {

using Imath::V2f;

constexpr float cell_spacings = 1.5F;            ///< edge of a cell, in point spacings
constexpr double most_cells_per_point = 4;       ///< for patches with large holes
constexpr std::uint32_t least_grid_points = 24;  ///< fewer are searched through
constexpr float cell_rounding = 1e-3F;           ///< of coordinates that count cells

/// The cell of a coordinate; places outside count to the cells at the border.
std::uint32_t cell_of(float from_corner, float per_unit, std::uint32_t cells) {
    return static_cast<std::uint32_t>(std::clamp(from_corner * per_unit, 0.0F, static_cast<float>(cells - 1)));
}

}  // namespace

PatchPoints::PatchPoints(const PointCloud& cloud, const PatchSet& set)
    : grids_(set.patches.size()), entries_(cloud.size()) {
    std::size_t cells = 0;
    for (std::size_t p = 0; p < grids_.size(); ++p) {
        const Patch& patch = set.patches[p];
        Grid& grid = grids_[p];
        grid.first_cell = cells;
        if (patch.point_count >= least_grid_points) {
            Imath::Box2f box;
            for (const std::uint32_t i : set.points_of(patch)) box.extendBy(patch.to_plane(cloud.positions[i]));
            const V2f size = box.size();
            const double most = most_cells_per_point * patch.point_count;
            const double edge = std::max(static_cast<double>(cell_spacings * patch.spacing()),
                                         std::sqrt(static_cast<double>(size.x) * static_cast<double>(size.y) / most) +
                                             static_cast<double>(std::max(size.x, size.y)) / most);
            if (edge > 0 && std::isfinite(edge)) {
                grid.corner = box.min;
                grid.per_unit = static_cast<float>(1 / edge);
                grid.columns = static_cast<std::uint32_t>(static_cast<double>(size.x) / edge) + 1;
                grid.rows = static_cast<std::uint32_t>(static_cast<double>(size.y) / edge) + 1;
            }
        }
        cells += std::size_t{grid.columns} * grid.rows + 1;
    }
    first_entry_.resize(cells);

    tbb::parallel_for(std::size_t{0}, grids_.size(), [&](std::size_t p) {
        const Patch& patch = set.patches[p];
        const Grid& grid = grids_[p];
        std::uint32_t* first = first_entry_.data() + grid.first_cell;
        const auto cell = [&](const V2f& place) {
            return cell_of(place.y - grid.corner.y, grid.per_unit, grid.rows) * grid.columns +
                   cell_of(place.x - grid.corner.x, grid.per_unit, grid.columns);
        };
        const std::uint32_t count = grid.columns * grid.rows;
        for (const std::uint32_t i : set.points_of(patch)) ++first[cell(patch.to_plane(cloud.positions[i])) + 1];
        first[0] = patch.first_point;
        for (std::uint32_t c = 0; c < count; ++c) first[c + 1] += first[c];
        std::vector<std::uint32_t> next(first, first + count);
        for (const std::uint32_t i : set.points_of(patch)) {
            const V2f place = patch.to_plane(cloud.positions[i]);
            entries_[next[cell(place)]++] = {place, i};
        }
    });
}

std::uint32_t PatchPoints::nearest(std::uint32_t patch, const V2f& place) const {
    const Grid& grid = grids_[patch];
    const std::uint32_t* first = first_entry_.data() + grid.first_cell;
    const auto column = static_cast<int>(cell_of(place.x - grid.corner.x, grid.per_unit, grid.columns));
    const auto row = static_cast<int>(cell_of(place.y - grid.corner.y, grid.per_unit, grid.rows));
    const auto columns = static_cast<int>(grid.columns);
    const auto rows = static_cast<int>(grid.rows);
    std::uint32_t best = 0;
    float least = std::numeric_limits<float>::infinity();
    // Squares of cells around the place, until nothing outside of the last one can be nearer.
    const V2f in_cells = (place - grid.corner) * grid.per_unit;
    const auto reach = [&](int ring) {  // in cells; only sides with cells beyond them count
        constexpr float all = std::numeric_limits<float>::infinity();
        const float left = column > ring ? in_cells.x - static_cast<float>(column - ring) : all;
        const float right = column + ring + 1 < columns ? static_cast<float>(column + ring + 1) - in_cells.x : all;
        const float below = row > ring ? in_cells.y - static_cast<float>(row - ring) : all;
        const float above = row + ring + 1 < rows ? static_cast<float>(row + ring + 1) - in_cells.y : all;
        return std::max(std::min({left, right, below, above}) - cell_rounding, 0.0F);
    };
    for (int ring = 0; ring <= std::max(columns, rows); ++ring) {
        const auto visit = [&](int x, int y) {
            const int at = y * columns + x;
            for (std::uint32_t e = first[at]; e < first[at + 1]; ++e) {
                const float distance = (entries_[e].place - place).length2();
                if (distance > least || (distance == least && entries_[e].point > best)) continue;
                least = distance;
                best = entries_[e].point;
            }
        };
        const int left = std::max(column - ring, 0);
        const int right = std::min(column + ring, columns - 1);
        for (int y = std::max(row - ring, 0); y <= std::min(row + ring, rows - 1); ++y) {
            const bool whole_row = y == row - ring || y == row + ring;
            for (int x = left; x <= right; ++x)
                if (whole_row || x == column - ring || x == column + ring) visit(x, y);
        }
        const float reached = reach(ring);
        if (std::sqrt(least) * grid.per_unit <= reached) break;
    }
    return best;
}

}  // namespace vmap
