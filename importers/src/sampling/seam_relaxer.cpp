// SPDX-License-Identifier: GPL-3.0-or-later
#include "seam_relaxer.h"

#include "point_grid.h"
#include "stage_progress.h"
#include "surface_walk.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace vmap {
namespace {

using Imath::V3d;
using Imath::V3f;

// Lengths in units of the spacing.
constexpr float seam_step = 0.5F;       ///< between samples of a seam
constexpr float active_reach = 0.85F;   ///< from a sample: points that move
constexpr float list_reach = 1.2F;      ///< of the lists of neighbours
constexpr float most_moved = 0.4F;      ///< from where a point began
constexpr float push_distance = 0.87F;  ///< points nearer than this push each other
constexpr float near_cell = 2.1F;       ///< cells next to seams: hold all neighbours of points that move
constexpr float push_step = 0.35F;
constexpr float same_side_cosine = 0.5F;  ///< points whose normals differ more do not see each other

/// Places every half spacing along the edges where parts meet that were sampled on their own.
std::vector<V3f> sample_seams(const LitSurface& surface, const Charts& charts, const SeamParts& parts, double spacing) {
    const auto is_seam = [&](std::uint32_t t, std::uint32_t other) {
        if (other == no_neighbour || parts.pool_of[t] == parts.pool_of[other]) return false;
        return charts.chart_of[t] != charts.chart_of[other] || parts.is_loose[parts.pool_of[t]] ||
               parts.is_loose[parts.pool_of[other]];
    };
    std::vector<V3f> samples;
    for (std::uint32_t t = 0; t < surface.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t other = charts.neighbours[t][k];
            if (!is_seam(t, other) || (t > other && is_seam(other, t))) continue;
            const auto corners = surface.corners(surface.triangles[t]);
            const V3d from = corners[k] / spacing;
            const V3d along = corners[(k + 1) % 3] / spacing - from;
            const int steps = static_cast<int>(std::ceil(along.length() / seam_step));
            for (int i = 0; i < steps; ++i) samples.emplace_back(from + along * ((i + 0.5) / steps));
        }
    return samples;
}

/// The cells of seam samples and all around them.
CellTable cells_near(std::span<const V3f> samples) {
    std::vector<std::uint64_t> keys;
    keys.reserve(samples.size());
    std::vector<std::uint64_t> centers;
    for (const V3f& sample : samples) {
        const Imath::V3i center = cell_at(sample / near_cell);
        const std::uint64_t key = cell_key(center);
        if (!centers.empty() && centers.back() == key) continue;
        centers.push_back(key);
        for (int z = -1; z <= 1; ++z)
            for (int y = -1; y <= 1; ++y)
                for (int x = -1; x <= 1; ++x) keys.push_back(cell_key(center + Imath::V3i(x, y, z)));
    }
    tbb::parallel_sort(keys);
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    return CellTable(keys);
}

class Relaxer {
public:
    Relaxer(const LitSurface& surface, const SurfaceShading& shading, const Charts& charts, const SeamParts& parts,
            double spacing, std::span<PlacedPoint> points)
        : surface_(surface), shading_(shading), charts_(charts), parts_(parts), spacing_(spacing), points_(points) {}

    void run(const ProgressCallback& progress) {
        constexpr double farthest = 1e6;  // floats would blur the spacing
        if (surface_.extent / spacing_ > farthest) return;
        const std::vector<V3f> seams = sample_seams(surface_, charts_, parts_, spacing_);
        if (seams.empty()) return;
        collect(cells_near(seams));
        report_progress(progress, "sample", 0.45);
        list_neighbours(seams);
        const int rounds = active_.size() < 100'000 ? 15 : 7;  // the last ones change little
        StageProgress stage(progress, 0.5, 0.7, rounds);
        for (int round = 0; round < rounds; ++round) {
            push_once();
            stage.advance();
        }
        while (undo_squeezed()) {
        }
        tbb::parallel_for(std::size_t{0}, near_.size(), [&](std::size_t i) { points_[near_[i]] = now_[i]; });
    }

private:
    /// Some of the points that move, and their neighbours: numbers among the near points.
    struct Block {
        std::vector<std::uint32_t> neighbours;
        std::vector<std::uint32_t> ends;  ///< of each point's list
    };
    static constexpr std::size_t block_size = 512;

    [[nodiscard]] V3d place_of(const PlacedPoint& point) const {
        const auto [a, b, c] = surface_.corners(surface_.triangles[point.triangle]);
        return (a + (b - a) * (point.u * PlacedPoint::unit) + (c - a) * (point.v * PlacedPoint::unit)) / spacing_;
    }
    [[nodiscard]] const V3f& normal_of(std::uint32_t i) const { return surface_.triangles[now_[i].triangle].normal; }

    void collect(const CellTable& cells) {
        std::vector<std::uint8_t> is_near(points_.size());
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points_.size(), 4096), [&](const auto& range) {
            for (std::size_t i = range.begin(); i < range.end(); ++i)
                is_near[i] = cells.find(cell_key(cell_at(V3f(place_of(points_[i])) / near_cell))) != CellTable::none;
        });
        for (std::uint32_t i = 0; i < points_.size(); ++i)
            if (is_near[i] != 0) near_.push_back(i);
        now_.resize(near_.size());
        places_.resize(near_.size());
        tbb::parallel_for(std::size_t{0}, near_.size(), [&](std::size_t i) {
            now_[i] = points_[near_[i]];
            places_[i] = V3f(place_of(now_[i]));
        });
    }

    void list_neighbours(std::span<const V3f> seams) {
        std::vector<V3f> in_cells(places_.size());
        for (std::size_t i = 0; i < places_.size(); ++i) in_cells[i] = places_[i] / list_reach;
        const PointGrid grid(in_cells);

        std::vector<std::uint8_t> is_active(places_.size(), 0);
        tbb::parallel_for(std::size_t{0}, seams.size(), [&](std::size_t s) {
            grid.for_each_around(seams[s] / list_reach, [&](std::uint32_t i) {
                if ((places_[i] - seams[s]).length2() < active_reach * active_reach)
                    std::atomic_ref(is_active[i]).store(1, std::memory_order_relaxed);
            });
        });
        for (std::uint32_t i = 0; i < places_.size(); ++i)
            if (is_active[i] != 0) {
                active_.push_back(i);
                began_.push_back(places_[i]);
            }

        blocks_.resize((active_.size() + block_size - 1) / block_size);
        tbb::parallel_for(std::size_t{0}, blocks_.size(), [&](std::size_t b) {
            Block& block = blocks_[b];
            for_each_active(b, [&](std::size_t a, std::size_t) {
                const std::uint32_t i = active_[a];
                grid.for_each_around(in_cells[i], [&](std::uint32_t j) {
                    if (j != i && (places_[j] - places_[i]).length2() < list_reach * list_reach &&
                        normal_of(j).dot(normal_of(i)) > same_side_cosine)
                        block.neighbours.push_back(j);
                });
                block.ends.push_back(static_cast<std::uint32_t>(block.neighbours.size()));
            });
        });
    }

    /// Calls visit(number among the points that move, number in the block).
    template <class Visit>
    void for_each_active(std::size_t block, const Visit& visit) const {
        const std::size_t first = block * block_size;
        const std::size_t last = std::min(first + block_size, active_.size());
        for (std::size_t a = first; a < last; ++a) visit(a, a - first);
    }

    static std::span<const std::uint32_t> neighbours(const Block& block, std::size_t number) {
        const std::uint32_t first = number == 0 ? 0 : block.ends[number - 1];
        return std::span(block.neighbours).subspan(first, block.ends[number] - first);
    }

    /// All points move at once, so that the order does not matter.
    void push_once() {
        std::vector<Place> moved(active_.size());
        tbb::parallel_for(std::size_t{0}, blocks_.size(), [&](std::size_t b) {
            for_each_active(b, [&](std::size_t a, std::size_t number) {
                const std::uint32_t i = active_[a];
                V3f push(0);
                for (const std::uint32_t j : neighbours(blocks_[b], number)) {
                    const V3f away = places_[i] - places_[j];
                    const float square = away.length2();
                    if (square >= push_distance * push_distance || square == 0) continue;
                    push += away * (push_distance / std::sqrt(square) - 1);
                }
                moved[a] = stepped(i, a, push * push_step);
            });
        });
        tbb::parallel_for(std::size_t{0}, active_.size(), [&](std::size_t a) { put(active_[a], moved[a]); });
    }

    struct Place {
        PlacedPoint point;
        V3f place{0, 0, 0};
    };

    [[nodiscard]] Place stepped(std::uint32_t i, std::size_t a, const V3f& step) const {
        if (step == V3f(0)) return {now_[i], places_[i]};
        const WalkEnd end = walk(surface_, charts_.neighbours, parts_.pool_of, now_[i], V3d(step) * spacing_);
        const V3f place(end.place / spacing_);
        if ((place - began_[a]).length2() > most_moved * most_moved) return {now_[i], places_[i]};
        const LitTriangle& triangle = surface_.triangles[end.point.triangle];
        if (surface_.is_masked(triangle) && shading_.is_cut(surface_.place(triangle, end.point.u * PlacedPoint::unit,
                                                                           end.point.v * PlacedPoint::unit, 0)))
            return {now_[i], places_[i]};
        return {end.point, place};
    }

    void put(std::uint32_t i, const Place& place) {
        now_[i] = place.point;
        places_[i] = place.place;
    }

    /// Puts points back that came too near another of the same flat part; true when there were any. It ends, because
    /// each time more points are back where they began.
    bool undo_squeezed() {
        std::vector<std::uint8_t> is_squeezed(near_.size(), 0);
        const auto has_moved = [&](std::uint32_t i) {
            const PlacedPoint& before = points_[near_[i]];
            return before.triangle != now_[i].triangle || before.u != now_[i].u || before.v != now_[i].v;
        };
        std::atomic<bool> any = false;
        tbb::parallel_for(std::size_t{0}, blocks_.size(), [&](std::size_t b) {
            for_each_active(b, [&](std::size_t a, std::size_t number) {
                const std::uint32_t i = active_[a];
                for (const std::uint32_t j : neighbours(blocks_[b], number)) {
                    if (charts_.flats.of[now_[i].triangle] != charts_.flats.of[now_[j].triangle]) continue;
                    if ((places_[i] - places_[j]).length() >= kept_distance) continue;
                    for (const std::uint32_t k : {i, j}) {
                        if (!has_moved(k)) continue;
                        std::atomic_ref(is_squeezed[k]).store(1, std::memory_order_relaxed);
                        any = true;
                    }
                }
            });
        });
        if (!any) return false;
        tbb::parallel_for(std::size_t{0}, active_.size(), [&](std::size_t a) {
            const std::uint32_t i = active_[a];
            if (is_squeezed[i] != 0) put(i, {points_[near_[i]], began_[a]});
        });
        return true;
    }

    const LitSurface& surface_;
    const SurfaceShading& shading_;
    const Charts& charts_;
    const SeamParts& parts_;
    double spacing_;
    std::span<PlacedPoint> points_;      ///< where all points began
    std::vector<std::uint32_t> near_;    ///< numbers of the points near seams
    std::vector<PlacedPoint> now_;       ///< of the near points
    std::vector<V3f> places_;            ///< of the near points, in units of the spacing
    std::vector<std::uint32_t> active_;  ///< numbers among the near points: those that move
    std::vector<V3f> began_;             ///< places of the points that move, before they did
    std::vector<Block> blocks_;
};

}  // namespace

void relax_seams(const LitSurface& surface, const SurfaceShading& shading, const Charts& charts, const SeamParts& parts,
                 double spacing, const ProgressCallback& progress, std::span<PlacedPoint> points) {
    Relaxer(surface, shading, charts, parts, spacing, points).run(progress);
}

}  // namespace vmap
