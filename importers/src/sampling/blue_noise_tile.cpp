// SPDX-License-Identifier: GPL-3.0-or-later
#include "blue_noise_tile.h"

#include "random_numbers.h"

#include <Imath/ImathVec.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

namespace vmap {
namespace {

using Imath::V2f;

/// Places on a torus of side x side unit cells, sorted by cell.
class TorusPoints {
public:
    TorusPoints(int side, const std::vector<V2f>& places)
        : side_(side), first_(cells() + 1, 0), places_(places.size()) {
        for (const V2f& place : places) ++first_[cell_of(place) + 1];
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
        for (const V2f& place : places) places_[next[cell_of(place)]++] = place;
    }

    [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(places_.size()); }
    [[nodiscard]] int side() const { return side_; }
    [[nodiscard]] const V2f& operator[](std::uint32_t i) const { return places_[i]; }
    [[nodiscard]] const std::vector<std::uint32_t>& first_of_cells() const { return first_; }

    [[nodiscard]] std::uint32_t cell_of(const V2f& place) const {
        return static_cast<std::uint32_t>(column(place.y) * side_ + column(place.x));
    }

    /// The same place in [0, side).
    [[nodiscard]] V2f wrapped(V2f place) const {
        const auto side = static_cast<float>(side_);
        for (float* x : {&place.x, &place.y}) {
            if (*x < 0) *x += side;
            if (*x >= side) *x -= side;
        }
        return place;
    }

    /// Calls visit(other, difference to it, distance) for every other place nearer than reach.
    template <class Visit>
    void for_each_near(std::uint32_t i, float reach, const Visit& visit) const {
        const int steps = static_cast<int>(std::ceil(reach));
        const int x0 = column(places_[i].x);
        const int y0 = column(places_[i].y);
        const auto side = static_cast<float>(side_);
        for (int dy = -steps; dy <= steps; ++dy)
            for (int dx = -steps; dx <= steps; ++dx) {
                const int cell = (y0 + dy + side_) % side_ * side_ + (x0 + dx + side_) % side_;
                for (std::uint32_t k = first_[cell]; k < first_[cell + 1]; ++k) {
                    V2f difference = places_[k] - places_[i];
                    for (float* x : {&difference.x, &difference.y}) {
                        if (*x > side / 2) *x -= side;
                        if (*x < -side / 2) *x += side;
                    }
                    const float square = difference.length2();
                    if (k != i && square < reach * reach) visit(k, difference, std::sqrt(square));
                }
            }
    }

private:
    [[nodiscard]] std::size_t cells() const { return static_cast<std::size_t>(side_) * side_; }
    [[nodiscard]] int column(float x) const { return std::min(static_cast<int>(x), side_ - 1); }

    int side_;
    std::vector<std::uint32_t> first_;
    std::vector<V2f> places_;
};

/// For each cell a place at random in the square of two by two cells about it: one in each cell would leave a trace of
/// the cells once the points are pushed apart.
TorusPoints jittered_points(int side, std::uint64_t seed) {
    const auto wrap = [side](double x) { return static_cast<float>(x < side ? x : x - side); };
    std::vector<V2f> places;
    places.reserve(static_cast<std::size_t>(side) * side);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const std::uint64_t hash = hash_bits(seed, places.size());
            places.emplace_back(wrap(x + 2 * upper_unit(hash)), wrap(y + 2 * lower_unit(hash)));
        }
    return {side, places};
}

/// Points that are nearer to each other than `distance`, in root of a cell, push each other away.
TorusPoints pushed_apart(const TorusPoints& points, float distance, float step) {
    std::vector<V2f> places(points.size());
    tbb::parallel_for(std::uint32_t{0}, points.size(), [&](std::uint32_t i) {
        V2f push(0, 0);
        points.for_each_near(i, distance, [&](std::uint32_t, const V2f& difference, float here) {
            if (here > 0) push -= difference * ((distance - here) / here);
        });
        places[i] = points.wrapped(points[i] + push * step);
    });
    return {points.side(), places};
}

/// Spread evenly: first as many everywhere, then at some distance from each other. The densest lattice has 1.07; points
/// pushed near that would be a crystal.
TorusPoints even_points(int side, std::uint64_t seed) {
    TorusPoints points = jittered_points(side, seed);
    for (int k = 0; k < 8; ++k) points = pushed_apart(points, 1.5F, 0.1F);
    for (int k = 0; k < 20; ++k) points = pushed_apart(points, 0.87F, 0.3F);
    return points;
}

/// How crowded points are, and for each block of the torus a heap with its most crowded point on top.
class CrowdingHeaps {
public:
    CrowdingHeaps(std::vector<float> crowding, std::vector<std::uint32_t> block_of, std::uint32_t blocks)
        : crowding_(std::move(crowding)), block_of_(std::move(block_of)), heaps_(blocks), slot_(crowding_.size()) {
        for (std::uint32_t i = 0; i < crowding_.size(); ++i) {
            slot_[i] = static_cast<std::uint32_t>(heap_of(i).size());
            heap_of(i).push_back(i);
        }
        for (std::vector<std::uint32_t>& heap : heaps_)
            for (auto slot = static_cast<std::uint32_t>(heap.size() / 2); slot-- > 0;) sink(heap, slot);
    }

    [[nodiscard]] bool contains(std::uint32_t i) const { return slot_[i] != gone; }
    [[nodiscard]] bool is_empty(std::uint32_t block) const { return heaps_[block].empty(); }

    std::uint32_t pop(std::uint32_t block) {
        std::vector<std::uint32_t>& heap = heaps_[block];
        const std::uint32_t top = heap.front();
        put(heap, 0, heap.back());
        heap.pop_back();
        slot_[top] = gone;
        if (!heap.empty()) sink(heap, 0);
        return top;
    }

    void lower(std::uint32_t i, float by) {
        crowding_[i] -= by;
        sink(heap_of(i), slot_[i]);
    }

private:
    static constexpr std::uint32_t gone = 0xFFFFFFFF;

    std::vector<std::uint32_t>& heap_of(std::uint32_t i) { return heaps_[block_of_[i]]; }
    void put(std::vector<std::uint32_t>& heap, std::uint32_t slot, std::uint32_t i) {
        heap[slot] = i;
        slot_[i] = slot;
    }
    void sink(std::vector<std::uint32_t>& heap, std::uint32_t slot) {
        const std::uint32_t i = heap[slot];
        while (true) {
            std::uint32_t child = 2 * slot + 1;
            if (child >= heap.size()) break;
            if (child + 1 < heap.size() && crowding_[heap[child + 1]] > crowding_[heap[child]]) ++child;
            if (crowding_[heap[child]] <= crowding_[i]) break;
            put(heap, slot, heap[child]);
            slot = child;
        }
        put(heap, slot, i);
    }

    std::vector<float> crowding_;
    std::vector<std::uint32_t> block_of_;  ///< of each point
    std::vector<std::vector<std::uint32_t>> heaps_;
    std::vector<std::uint32_t> slot_;  ///< of each point in its heap
};

/// Takes the most crowded points away, from one block of the torus after the other, so that those that are left are as
/// many everywhere, until `target` are left; returns those taken, in that order.
std::vector<std::uint32_t> eliminate(const TorusPoints& points, std::size_t target, std::uint64_t seed) {
    constexpr int block_side = 8;
    constexpr double cells_per_point = 1.5;  // share of the torus for which points are to be spread best
    // Twice the radius of disks that would cover the torus in the densest packing.
    const auto reach = static_cast<float>(2 * std::sqrt(cells_per_point / (2 * std::numbers::sqrt3)));
    const auto crowd = [reach](float distance) {
        const float closeness = 1 - distance / reach;
        const float square = closeness * closeness;
        return square * square * square * square;
    };
    const int blocks_across = points.side() / block_side;
    std::vector<float> crowding(points.size(), 0);
    std::vector<std::uint32_t> block_of(points.size());
    tbb::parallel_for(std::uint32_t{0}, points.size(), [&](std::uint32_t i) {
        block_of[i] =
            static_cast<int>(points[i].y / block_side) * blocks_across + static_cast<int>(points[i].x / block_side);
        points.for_each_near(i, reach,
                             [&](std::uint32_t, const V2f&, float distance) { crowding[i] += crowd(distance); });
    });

    std::vector<std::uint32_t> order(static_cast<std::size_t>(blocks_across) * blocks_across);
    std::iota(order.begin(), order.end(), 0U);
    CrowdingHeaps heaps(std::move(crowding), std::move(block_of), static_cast<std::uint32_t>(order.size()));
    std::vector<std::uint32_t> taken;
    for (std::uint64_t round = 0; points.size() - taken.size() > target; ++round) {
        std::ranges::sort(order, {}, [&](std::uint32_t block) { return hash_bits(hash_bits(seed, round), block); });
        for (const std::uint32_t block : order) {
            if (heaps.is_empty(block)) continue;
            const std::uint32_t i = heaps.pop(block);
            taken.push_back(i);
            points.for_each_near(i, reach, [&](std::uint32_t j, const V2f&, float distance) {
                if (heaps.contains(j)) heaps.lower(j, crowd(distance));
            });
        }
    }
    return taken;
}

}  // namespace

BlueNoiseTile make_blue_noise_tile(int side, std::uint64_t seed) {
    const TorusPoints points = even_points(side, seed);

    // Below two fifths of the points nobody asks for an order.
    const std::uint32_t count = points.size();
    const std::vector<std::uint32_t> taken = eliminate(points, count * 2 / 5, seed);
    std::vector<float> ranks(count);
    for (std::uint32_t i = 0; i < count; ++i) ranks[i] = static_cast<float>(0.4 * upper_unit(hash_bits(seed + 1, i)));
    for (std::uint32_t k = 0; k < taken.size(); ++k)
        ranks[taken[k]] = static_cast<float>(count - 1 - k) / static_cast<float>(count);

    BlueNoiseTile tile{.side = side, .first = points.first_of_cells(), .points = {}};
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t cell = points.cell_of(points[i]);
        const std::uint32_t row = cell / side;
        const std::uint32_t column = cell % side;
        tile.points.push_back(
            {points[i].x - static_cast<float>(column), points[i].y - static_cast<float>(row), ranks[i]});
    }
    return tile;
}

}  // namespace vmap
