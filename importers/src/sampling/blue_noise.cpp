// SPDX-License-Identifier: GPL-3.0-or-later
#include "blue_noise.h"

#include "blue_noise_tile.h"
#include "charts.h"
#include "random_numbers.h"
#include "seam_relaxer.h"
#include "share_out.h"
#include "stratified.h"
#include "tiled.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

namespace vmap {
namespace {

/// Flat parts with room for as many points get a number of their own.
constexpr double large_part = 8;

/// What one pool's triangles have in common.
struct PoolKey {
    std::uint32_t surface = 0;
    std::uint32_t chart = 0;
    std::uint32_t flat = 0;  ///< number of a large flat part; the same for all that is not
    std::uint32_t triangle = 0;

    [[nodiscard]] bool is_same_pool(const PoolKey& other) const {
        return surface == other.surface && chart == other.chart && flat == other.flat;
    }
    [[nodiscard]] bool operator<(const PoolKey& other) const {
        return std::tie(surface, chart, flat, triangle) <
               std::tie(other.surface, other.chart, other.flat, other.triangle);
    }
};

struct Pools {
    std::vector<std::uint32_t> triangles;  ///< pool after pool
    std::vector<Pool> pools;               ///< surface after surface
    std::vector<std::uint32_t> surfaces;   ///< of each pool
    std::vector<double> point_areas;       ///< of the points of each pool
};

Pools make_pools(const LitSurface& surface, const Charts& charts, double spacing) {
    const double large = large_part * spacing * spacing;
    std::vector<PoolKey> keys(surface.triangles.size());
    tbb::parallel_for(std::size_t{0}, keys.size(), [&](std::size_t t) {
        const std::uint32_t flat = charts.flats.of[t];
        keys[t] = {.surface = surface.triangles[t].surface,
                   .chart = charts.chart_of[t],
                   .flat = charts.flats.areas[flat] >= large ? flat : std::numeric_limits<std::uint32_t>::max(),
                   .triangle = static_cast<std::uint32_t>(t)};
    });
    tbb::parallel_sort(keys);

    Pools result;
    result.triangles.reserve(keys.size());
    for (std::size_t k = 0; k < keys.size(); ++k) {
        if (k == 0 || !keys[k].is_same_pool(keys[k - 1])) {
            result.pools.push_back({.chart = keys[k].chart, .first = k});
            result.surfaces.push_back(keys[k].surface);
        }
        result.pools.back().last = k + 1;
        result.pools.back().area += surface.triangles[keys[k].triangle].area;
        result.triangles.push_back(keys[k].triangle);
    }
    result.point_areas.resize(result.pools.size());
    return result;
}

/// Shares the points of one surface out to its pools. Small pools come first and along a curve through space, so that
/// those that are left without a point have neighbours that stand for them; all their points have the same area.
void share_out(const LitSurface& surface, double spacing, std::size_t begin, std::size_t end, std::size_t count,
               double offset, Pools& pools) {
    const double large = large_part * spacing * spacing;
    std::vector<std::pair<std::uint64_t, std::size_t>> order;
    for (std::size_t p = begin; p < end; ++p) {
        const bool is_large = pools.pools[p].area >= large;
        const std::uint64_t key = place_on_curve(surface, pools.triangles[pools.pools[p].first]);
        order.emplace_back(is_large ? std::numeric_limits<std::uint64_t>::max() : key, p);
    }
    std::ranges::sort(order);
    std::vector<double> areas;
    areas.reserve(order.size());
    for (const auto& [key, p] : order) areas.push_back(pools.pools[p].area);
    const std::vector<std::size_t> counts = share_out_in_order(areas, count, offset);

    double whole = 0;
    double held = 0;  // by pools that get points, small ones together
    double small = 0;
    std::size_t points_of_small = 0;
    for (std::size_t k = 0; k < order.size(); ++k) {
        pools.pools[order[k].second].points = counts[k];
        whole += areas[k];
        if (areas[k] < large) {
            small += areas[k];
            points_of_small += counts[k];
        } else if (counts[k] > 0) {
            held += areas[k];
        }
    }
    if (points_of_small > 0) held += small;
    for (std::size_t k = 0; k < order.size(); ++k) {
        if (counts[k] == 0) continue;
        const double share =
            areas[k] < large ? small / static_cast<double>(points_of_small) : areas[k] / static_cast<double>(counts[k]);
        pools.point_areas[order[k].second] = share * (whole / held);
    }
}

/// Side of a tile that is not repeated too often and takes little of the time.
int tile_side(std::size_t points) {
    int side = 32;
    while (side < 128 && 16 * static_cast<std::size_t>(side) * side < points) side *= 2;
    return side;
}

}  // namespace

Placement place_blue_noise(const LitSurface& surface, const SurfaceShading& shading,
                           std::span<const std::size_t> counts, double spacing, std::uint64_t seed,
                           const ProgressCallback& progress) {
    const Charts charts = find_charts(surface, spacing);
    report_progress(progress, "sample", 0.2);
    Pools pools = make_pools(surface, charts, spacing);
    for (std::size_t begin = 0, end = 0; begin < pools.pools.size(); begin = end) {
        const std::uint32_t s = pools.surfaces[begin];
        for (end = begin; end < pools.pools.size() && pools.surfaces[end] == s;) ++end;
        share_out(surface, spacing, begin, end, counts[s], upper_unit(hash_bits(seed, s)), pools);
    }

    Placement placement;
    placement.points.resize(std::accumulate(counts.begin(), counts.end(), std::size_t{0}));
    const BlueNoiseTile tile = make_blue_noise_tile(tile_side(placement.points.size()), hash_bits(seed));
    SeamParts parts;
    parts.is_loose = place_tiled(surface, charts, pools.triangles, pools.pools, tile, shading, spacing, seed, progress,
                                 placement.points);

    parts.pool_of.resize(surface.triangles.size());
    std::size_t first = 0;
    for (std::size_t p = 0; p < pools.pools.size(); ++p) {
        const Pool& pool = pools.pools[p];
        const auto triangles = std::span(pools.triangles).subspan(pool.first, pool.last - pool.first);
        for (const std::uint32_t t : triangles) parts.pool_of[t] = static_cast<std::uint32_t>(p);
        if (parts.is_loose[p]) {
            const std::span<PlacedPoint> points = std::span(placement.points).subspan(first, pool.points);
            place_stratified(surface, triangles, hash_bits(seed, p), points);
            move_off_cuts(surface, shading, hash_bits(seed, p), points);
        }
        first += pool.points;
        placement.areas.insert(placement.areas.end(), pool.points, static_cast<float>(pools.point_areas[p]));
    }
    relax_seams(surface, shading, charts, parts, spacing, progress, placement.points);
    return placement;
}

}  // namespace vmap
