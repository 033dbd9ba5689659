// SPDX-License-Identifier: Apache-2.0
#include "octree_grid.h"

#include <vmap/error.h>

#include <Imath/ImathBox.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace vmap {
namespace {

using Imath::V3d;
using Imath::V3f;
using Imath::V3i;

/// Borders of cells should not fall on walls that stand at round fractions of the scene, where rounding would deal the
/// points of one wall out to two cells. So the grid starts a little below the scene and is a little larger.
constexpr double grid_shift = 0.00037;
constexpr double grid_slack = 0.0017;

bool is_finite(const V3f& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Box of the positions; throws at the first point (by index) that is not finite.
Imath::Box3f checked_bounds(const PointCloud& cloud) {
    struct Part {
        Imath::Box3f box;
        std::size_t broken = no_index;
    };
    const Part all = tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, cloud.size(), 4096), Part{},
        [&](const tbb::blocked_range<std::size_t>& range, Part part) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) {
                if (is_finite(cloud.positions[i]) && is_finite(cloud.normals[i]))
                    part.box.extendBy(cloud.positions[i]);
                else
                    part.broken = std::min(part.broken, i);
            }
            return part;
        },
        [](Part a, const Part& b) {
            a.box.extendBy(b.box);
            a.broken = std::min(a.broken, b.broken);
            return a;
        });
    if (all.broken != no_index)
        throw UnsupportedInput("point " + std::to_string(all.broken) +
                               " has a position or normal that is not finite; expected finite numbers");
    return all.box;
}

double longest_edge(const Imath::Box3f& box) {
    if (box.isEmpty()) return 0;
    const V3d size = V3d(box.max) - V3d(box.min);
    return std::max({size.x, size.y, size.z});
}

/// A millionth or so of the scene, and what floats far from their origin can tell apart.
float height_rounding(const Imath::Box3f& box) {
    double largest = 0;
    for (int axis = 0; axis < 3; ++axis)
        largest = std::max({largest, std::abs(double{box.min[axis]}), std::abs(double{box.max[axis]})});
    const double diagonal = (V3d(box.max) - V3d(box.min)).length();
    return static_cast<float>(4e-6 * diagonal + 4 * double{std::numeric_limits<float>::epsilon()} * largest);
}

void check(const OctreeConfig& config, double extent) {
    if (!(config.cell_size >= 0) || !std::isfinite(config.cell_size))
        throw UsageError("octree cell size is " + std::to_string(config.cell_size) + "; expected 0 or more");
    if (config.kind == OctreeKind::uniform && config.cell_size == 0)
        throw UsageError("a uniform octree needs a cell size above 0");
    if (config.kind == OctreeKind::uniform && extent > config.cell_size * (1 << max_uniform_levels))
        throw UsageError("octree cell size is below 1/1024 of the scene; a uniform octree has no smaller cells");
    if (config.kind == OctreeKind::adaptive && config.cell_size == 0 && config.points_per_leaf == 0)
        throw UsageError("an adaptive octree needs a cell size or a number of points per leaf above 0");
}

/// Moves bit i of a 20-bit number to bit 3 i.
std::uint64_t spread_bits(std::uint64_t x) {
    x = (x | x << 32) & 0x001f00000000ffffU;
    x = (x | x << 16) & 0x001f0000ff0000ffU;
    x = (x | x << 8) & 0x100f00f00f00f00fU;
    x = (x | x << 4) & 0x10c30c30c30c30c3U;
    return (x | x << 2) & 0x1249249249249249U;
}

/// Dominant axis of a normal and its sign, 0 to 5. The weights move the borders between classes away from 45 degrees,
/// where people build roofs and turned boxes whose normals rounding would deal out to both sides.
std::uint64_t orientation_class(const V3f& normal) {
    const float x = std::abs(normal.x);
    const float y = std::abs(normal.y) * 1.1F;
    const float z = std::abs(normal.z) * 0.9F;
    if (x >= y && x >= z) return normal.x < 0;
    return y >= z ? 2 + (normal.y < 0) : 4 + (normal.z < 0);
}

}  // namespace

V3i OctreeGrid::cell(const V3f& position) const {
    const V3d scaled = (V3d(position) - corner) * cells_per_unit;
    const int last = (1 << levels) - 1;
    const auto index = [last](double x) { return std::clamp(static_cast<int>(x), 0, last); };
    return {index(scaled.x), index(scaled.y), index(scaled.z)};
}

std::uint64_t OctreeGrid::key(const V3f& position, const V3f& normal) const {
    const V3i at = cell(position);
    return orientation_class(normal) << (3 * levels) | spread_bits(at.x) << 2 | spread_bits(at.y) << 1 |
           spread_bits(at.z);
}

OctreeGrid make_octree_grid(const PointCloud& cloud, const OctreeConfig& config) {
    const Imath::Box3f bounds = checked_bounds(cloud);
    const double extent = longest_edge(bounds);
    check(config, extent);
    if (extent == 0) return {};

    OctreeGrid grid;
    grid.corner = V3d(bounds.min) - V3d(grid_shift * extent);
    double edge = extent * (1 + grid_slack);
    grid.levels = max_octree_levels;
    grid.rounding = height_rounding(bounds);
    if (config.cell_size > 0) {
        const int limit = config.kind == OctreeKind::uniform ? max_uniform_levels : max_octree_levels;
        grid.levels = std::clamp(static_cast<int>(std::ceil(std::log2(edge / config.cell_size))), 0, limit);
        edge = std::max(edge, std::ldexp(config.cell_size, grid.levels));
    }
    grid.cells_per_unit = std::ldexp(1 / edge, grid.levels);
    return grid;
}

double cloud_extent(const PointCloud& cloud) {
    return longest_edge(checked_bounds(cloud));
}

}  // namespace vmap
