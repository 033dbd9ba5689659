// SPDX-License-Identifier: GPL-3.0-or-later
#include "tiled.h"

#include "random_numbers.h"
#include "stage_progress.h"
#include "triangle_raster.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace vmap {
namespace {

using Imath::V2d;
using Imath::V3d;

/// A chart's plane in cells of the tile.
struct Frame {
    V3d x_axis{1, 0, 0};
    V3d y_axis{0, 1, 0};
    V2d shift{0, 0};

    Frame(const Chart& chart, double cells_per_unit, int tile_side, std::uint64_t key) {
        const V3d& n = chart.normal;
        const V3d helper = std::abs(n.x) < 0.6 ? V3d(1, 0, 0) : V3d(0, 1, 0);
        const V3d a = n.cross(helper).normalized();
        const V3d b = n.cross(a);
        const double angle = 2 * std::numbers::pi * upper_unit(hash_bits(key, 1));
        x_axis = (a * std::cos(angle) + b * std::sin(angle)) * cells_per_unit;
        y_axis = (b * std::cos(angle) - a * std::sin(angle)) * cells_per_unit;
        const std::uint64_t hash = hash_bits(key, 2);
        shift = V2d(upper_unit(hash), lower_unit(hash)) * tile_side;
    }
    [[nodiscard]] V2d operator()(const V3d& p) const { return V2d(p.dot(x_axis), p.dot(y_axis)) + shift; }
};

/// A point of the tile on the surface, before one knows whether it counts.
struct Candidate {
    PlacedPoint point;
    std::uint32_t key = 0;  ///< rank: those with the lowest count
};

/// Some triangles of a pool, or some rows of one large triangle.
struct Job {
    std::uint32_t pool = 0;
    std::size_t first = 0;
    std::size_t last = 0;
    int part = 0;
    int parts = 1;
    std::vector<Candidate> found;
};

/// How much denser than needed the tile has to be for a pool: by chance fewer points than expected fall inside.
double margin_of(const Pool& pool, double spacing) {
    constexpr double most = 1.4;  // where more is needed another place of the tile may do
    const auto points = static_cast<double>(pool.points);
    const double wanted = points * spacing * spacing / pool.area;
    return std::min(wanted * (1.01 + 2.5 * std::pow(points, -0.75)), most);
}

class Tiler {
public:
    Tiler(const LitSurface& surface, const Charts& charts, std::span<const std::uint32_t> triangles,
          std::span<const Pool> pools, const BlueNoiseTile& tile, const SurfaceShading& shading, double spacing,
          std::uint64_t seed, std::span<PlacedPoint> points)
        : surface_(surface),
          charts_(charts),
          triangles_(triangles),
          pools_(pools),
          tile_(tile),
          shading_(shading),
          spacing_(spacing),
          seed_(seed),
          points_(points),
          state_(pools.size(), State::open),
          margins_(charts.charts.size(), 0) {
        firsts_.reserve(pools.size());
        std::size_t first = 0;
        for (std::size_t p = 0; p < pools.size(); ++p) {
            const Pool& pool = pools[p];
            firsts_.push_back(first);
            first += pool.points;
            if (pool.points == 0) state_[p] = State::done;
            if (is_alone(pool)) state_[p] = State::loose;
            if (state_[p] != State::open) continue;
            double& margin = margins_[pool.chart];
            margin = std::max(margin, margin_of(pool, spacing));
        }
    }

    /// Tries once all that is open; true when something stays open.
    bool try_once(const ProgressCallback& progress) {
        std::vector<Job> jobs = make_jobs();
        StageProgress stage(progress, tries_ == 0 ? 0.2 : 0.4, 0.4, jobs.size());
        tbb::parallel_for(std::size_t{0}, jobs.size(), [&](std::size_t i) {
            fill(jobs[i]);
            stage.advance();
        });

        std::vector<std::pair<std::size_t, std::size_t>> ranges;  // jobs of each pool
        for (std::size_t begin = 0, end = 0; begin < jobs.size(); begin = end) {
            for (end = begin; end < jobs.size() && jobs[end].pool == jobs[begin].pool;) ++end;
            ranges.emplace_back(begin, end);
        }
        tbb::parallel_for(std::size_t{0}, ranges.size(), [&](std::size_t i) {
            const auto [begin, end] = ranges[i];
            select(std::span(jobs).subspan(begin, end - begin));
        });
        return reopen_short_charts();
    }

    [[nodiscard]] std::vector<bool> loose() const {
        std::vector<bool> result;
        result.reserve(state_.size());
        for (const State state : state_) result.push_back(state == State::loose);
        return result;
    }

private:
    enum class State : std::uint8_t { open, done, loose };

    /// A single point on a small part may lie anywhere; the tile would seldom have one there.
    [[nodiscard]] bool is_alone(const Pool& pool) const {
        return pool.points == 1 && pool.area < 0.5 * spacing_ * spacing_;
    }

    [[nodiscard]] std::vector<Job> make_jobs() const {
        constexpr double work = 20000;  // points of a job
        std::vector<Job> jobs;
        for (std::uint32_t p = 0; p < pools_.size(); ++p) {
            if (state_[p] != State::open) continue;
            Job job{.pool = p, .first = pools_[p].first, .found = {}};
            double expected = 0;
            for (std::size_t t = pools_[p].first; t < pools_[p].last; ++t) {
                const double here = 1 + surface_.triangles[triangles_[t]].area / (spacing_ * spacing_);
                if (here > 2 * work) {
                    job.last = t;
                    if (job.last > job.first) jobs.push_back(job);
                    const int parts = static_cast<int>(here / work);
                    for (int part = 0; part < parts; ++part)
                        jobs.push_back(
                            {.pool = p, .first = t, .last = t + 1, .part = part, .parts = parts, .found = {}});
                    job.first = t + 1;
                    expected = 0;
                    continue;
                }
                expected += here;
                if (expected < work) continue;
                job.last = t + 1;
                jobs.push_back(job);
                job.first = t + 1;
                expected = 0;
            }
            job.last = pools_[p].last;
            if (job.last > job.first) jobs.push_back(job);
        }
        return jobs;
    }

    void fill(Job& job) const {
        const std::uint32_t number = pools_[job.pool].chart;
        const Chart& chart = charts_.charts[number];
        const double cells_per_unit = std::sqrt(margins_[number] / chart.min_cosine) / spacing_;
        const Frame frame(chart, cells_per_unit, tile_.side, hash_bits(hash_bits(seed_, number), tries_));
        for (std::size_t t = job.first; t < job.last; ++t) lay(frame, chart, triangles_[t], job);
    }

    void lay(const Frame& frame, const Chart& chart, std::uint32_t number, Job& job) const {
        const LitTriangle& triangle = surface_.triangles[number];
        const auto [a, b, c] = surface_.corners(triangle);
        const PlaneTriangle plane({frame(a), frame(b), frame(c)});
        const bool is_masked = surface_.is_masked(triangle);
        const double cosine = V3d(triangle.normal).dot(chart.normal);
        if (cosine < folded_cosine) return;
        const double shown = std::max(cosine, chart.min_cosine);
        const auto [low, high] = plane.rows();
        const std::int64_t begin = low + (high - low) * job.part / job.parts;
        const std::int64_t end = low + (high - low) * (job.part + 1) / job.parts;
        for (std::int64_t row = begin; row < end; ++row) {
            const auto [left, right] = plane.cells(row);
            for (std::int64_t column = left; column < right; ++column) {
                const auto cell = static_cast<std::uint32_t>(wrap(row) * tile_.side + wrap(column));
                for (std::uint32_t k = tile_.first[cell]; k < tile_.first[cell + 1]; ++k) {
                    const BlueNoiseTile::Point& point = tile_.points[k];
                    const V2d place(static_cast<double>(column) + point.x, static_cast<double>(row) + point.y);
                    if (!plane.contains(place)) continue;
                    const V2d uv = plane.weights(place);
                    if (is_masked && shading_.is_cut(surface_.place(triangle, uv.x, uv.y, 0))) continue;
                    job.found.push_back({placed_point(number, uv), key_of(point, row, column, shown)});
                }
            }
        }
    }

    [[nodiscard]] std::int64_t wrap(std::int64_t cell) const {
        const std::int64_t rest = cell % tile_.side;
        return rest < 0 ? rest + tile_.side : rest;
    }

    /// Repeats of a tile's point have ranks next to each other, in an order without pattern.
    [[nodiscard]] std::uint32_t key_of(const BlueNoiseTile::Point& point, std::int64_t row, std::int64_t column,
                                       double shown) const {
        const std::uint64_t hash =
            hash_bits(static_cast<std::uint64_t>(row) << 32 ^ static_cast<std::uint64_t>(column));
        const double rank = point.rank + upper_unit(hash) / (tile_.side * tile_.side);
        return static_cast<std::uint32_t>(rank * shown * (0x1p32 - 1));
    }

    /// Keeps as many points of a pool as it asks for, the lowest ranks.
    void select(std::span<Job> jobs) {
        const std::uint32_t number = jobs[0].pool;
        const std::size_t wanted = pools_[number].points;
        std::vector<std::uint32_t> keys;
        for (const Job& job : jobs)
            for (const Candidate& candidate : job.found) keys.push_back(candidate.key);
        if (keys.size() < wanted) return;
        std::ranges::nth_element(keys, keys.begin() + static_cast<std::ptrdiff_t>(wanted - 1));
        const std::uint32_t limit = keys[wanted - 1];
        auto ties = wanted - static_cast<std::size_t>(
                                 std::count_if(keys.begin(), keys.begin() + static_cast<std::ptrdiff_t>(wanted),
                                               [limit](std::uint32_t key) { return key < limit; }));
        keys = {};
        state_[number] = State::done;
        PlacedPoint* next = &points_[firsts_[number]];
        for (Job& job : jobs) {
            for (const Candidate& candidate : job.found) {
                if (candidate.key > limit) continue;
                if (candidate.key == limit && ties-- == 0) {
                    ties = 0;
                    continue;
                }
                *next++ = candidate.point;
            }
            job.found = {};
        }
    }

    /// All pools of a chart share one place and density of the tile, so that their points keep their distance: one
    /// short pool reopens all.
    bool reopen_short_charts() {
        constexpr int most_tries = 12;
        constexpr double more = 1.05;
        std::vector<bool> is_short(charts_.charts.size(), false);
        for (std::size_t p = 0; p < pools_.size(); ++p)
            if (state_[p] == State::open) is_short[pools_[p].chart] = true;
        const bool is_last = ++tries_ == most_tries;
        bool any = false;
        for (std::size_t p = 0; p < pools_.size(); ++p) {
            if (pools_[p].points == 0 || is_alone(pools_[p]) || !is_short[pools_[p].chart]) continue;
            any = true;
            if (!is_last) state_[p] = State::open;
            if (is_last && state_[p] == State::open) state_[p] = State::loose;
        }
        for (std::size_t chart = 0; chart < margins_.size(); ++chart)
            if (is_short[chart]) margins_[chart] *= more;
        return any && !is_last;
    }

    const LitSurface& surface_;
    const Charts& charts_;
    std::span<const std::uint32_t> triangles_;
    std::span<const Pool> pools_;
    const BlueNoiseTile& tile_;
    const SurfaceShading& shading_;
    double spacing_;
    std::uint64_t seed_;
    std::span<PlacedPoint> points_;
    std::vector<std::size_t> firsts_;  ///< point of each pool
    std::vector<State> state_;         ///< of each pool
    std::uint64_t tries_ = 0;
    std::vector<double> margins_;  ///< of each chart: density over what is needed where it is steepest
};

}  // namespace

std::vector<bool> place_tiled(const LitSurface& surface, const Charts& charts, std::span<const std::uint32_t> triangles,
                              std::span<const Pool> pools, const BlueNoiseTile& tile, const SurfaceShading& shading,
                              double spacing, std::uint64_t seed, const ProgressCallback& progress,
                              std::span<PlacedPoint> points) {
    Tiler tiler(surface, charts, triangles, pools, tile, shading, spacing, seed, points);
    while (tiler.try_once(progress)) {
    }
    return tiler.loose();
}

}  // namespace vmap
