// SPDX-License-Identifier: GPL-3.0-or-later
#include "blue_noise.h"

#include "blue_noise_tile.h"
#include "charts.h"
#include "random_numbers.h"
#include "share_out.h"
#include "stratified.h"
#include "tiled.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <vector>

namespace vmap {
namespace {

/// Parts with less than this many points are too small for the tile.
constexpr double smallest_pool = 8;

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
};

Pools make_pools(const LitSurface& surface, const Charts& charts, double spacing) {
    const double large = smallest_pool * spacing * spacing;
    std::vector<PoolKey> keys(surface.triangles.size());
    tbb::parallel_for(std::size_t{0}, keys.size(), [&](std::size_t t) {
        const std::uint32_t flat = charts.flat_of[t];
        keys[t] = {.surface = surface.triangles[t].surface,
                   .chart = charts.chart_of[t],
                   .flat = charts.flat_areas[flat] >= large ? flat : std::numeric_limits<std::uint32_t>::max(),
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
    return result;
}

class Placer {
public:
    Placer(const LitSurface& surface, const SurfaceShading& shading, double spacing, std::uint64_t seed)
        : surface_(surface), shading_(shading), spacing_(spacing), seed_(seed) {}

    Placement place(std::span<const std::size_t> counts, const ProgressCallback& progress) {
        const Charts charts = find_charts(surface_);
        report_progress(progress, "sample", 0.2);
        Pools pools = make_pools(surface_, charts, spacing_);
        for (std::size_t begin = 0, end = 0; begin < pools.pools.size(); begin = end) {
            for (end = begin; end < pools.pools.size() && pools.surfaces[end] == pools.surfaces[begin];) ++end;
            share_out(pools, begin, end, counts[pools.surfaces[begin]]);
        }

        std::size_t total = 0;
        for (const std::size_t count : counts) total += count;
        const BlueNoiseTile tile = make_blue_noise_tile(tile_side(total), hash_bits(seed_));
        report_progress(progress, "sample", 0.3);
        std::vector<std::vector<PlacedPoint>> tiled =
            place_tiled(surface_, charts, pools.triangles, large_, tile, shading_, spacing_, seed_);
        placement_.points.reserve(total);
        placement_.areas.reserve(total);
        for (std::size_t i = 0; i < large_.size(); ++i) {
            const Pool& pool = large_[i];
            const float area = static_cast<float>(large_areas_[i]);
            if (tiled[i].size() == pool.points) {
                placement_.points.insert(placement_.points.end(), tiled[i].begin(), tiled[i].end());
                placement_.areas.insert(placement_.areas.end(), tiled[i].size(), area);
                tiled[i] = {};
            } else {
                place_pieces(std::span(pools.triangles).subspan(pool.first, pool.last - pool.first), pool.points, area);
            }
        }
        for (SmallParts& small : small_) {
            sort_by_place(surface_, small.triangles);
            place_pieces(small.triangles, small.points, static_cast<float>(small.area_of_point));
        }
        return std::move(placement_);
    }

private:
    /// Small pools of one surface, taken together.
    struct SmallParts {
        std::vector<std::uint32_t> triangles;
        std::size_t points = 0;
        double area_of_point = 0;
    };

    /// Side of a tile that is not repeated too often and takes little of the time.
    static int tile_side(std::size_t points) {
        int side = 8;
        while (side < 128 && 64 * static_cast<std::size_t>(side) * side < points) side *= 2;
        return side;
    }

    /// Shares the points of one surface out to its pools.
    void share_out(const Pools& pools, std::size_t begin, std::size_t end, std::size_t count) {
        if (count == 0) return;
        SmallParts small;
        std::vector<double> areas{0};
        std::vector<std::size_t> large;
        for (std::size_t p = begin; p < end; ++p) {
            const Pool& pool = pools.pools[p];
            if (pool.area < smallest_pool * spacing_ * spacing_) {
                const auto first = pools.triangles.begin();
                small.triangles.insert(small.triangles.end(), first + static_cast<std::ptrdiff_t>(pool.first),
                                       first + static_cast<std::ptrdiff_t>(pool.last));
                areas[0] += pool.area;
            } else {
                areas.push_back(pool.area);
                large.push_back(p);
            }
        }
        const std::vector<std::size_t> shares =
            share_out_in_order(areas, count, upper_unit(hash_bits(seed_, pools.surfaces[begin])));

        // Parts without a point give their area to the others.
        double whole = 0;
        double held = 0;
        for (std::size_t i = 0; i < areas.size(); ++i) {
            whole += areas[i];
            if (shares[i] > 0) held += areas[i];
        }
        const double scale = whole / held;
        for (std::size_t i = 0; i < large.size(); ++i) {
            if (shares[i + 1] == 0) continue;
            Pool pool = pools.pools[large[i]];
            pool.points = shares[i + 1];
            large_.push_back(pool);
            large_areas_.push_back(pool.area * scale / static_cast<double>(pool.points));
        }
        small.points = shares[0];
        small.area_of_point = areas[0] * scale / static_cast<double>(std::max<std::size_t>(small.points, 1));
        if (small.points > 0) small_.push_back(std::move(small));
    }

    void place_pieces(std::span<const std::uint32_t> triangles, std::size_t count, float area) {
        const std::size_t first = placement_.points.size();
        placement_.points.resize(first + count);
        placement_.areas.resize(first + count, area);
        const std::uint64_t key = hash_bits(seed_, 1 + first);
        const std::span<PlacedPoint> points = std::span(placement_.points).subspan(first);
        place_stratified(surface_, triangles, key, points);
        move_off_cuts(surface_, shading_, key, points);
    }

    const LitSurface& surface_;
    const SurfaceShading& shading_;
    double spacing_;
    std::uint64_t seed_;
    std::vector<Pool> large_;
    std::vector<double> large_areas_;  ///< of each point of a large pool
    std::vector<SmallParts> small_;
    Placement placement_;
};

}  // namespace

Placement place_blue_noise(const LitSurface& surface, const SurfaceShading& shading,
                           std::span<const std::size_t> counts, double spacing, std::uint64_t seed,
                           const ProgressCallback& progress) {
    return Placer(surface, shading, spacing, seed).place(counts, progress);
}

}  // namespace vmap
