// SPDX-License-Identifier: GPL-3.0-or-later
#include "blue_noise_tile.h"

#include "random_numbers.h"

#include <Imath/ImathVec.h>

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

std::vector<V2f> random_places(int side, int per_cell, std::uint64_t seed) {
    std::vector<V2f> places;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            for (int k = 0; k < per_cell; ++k) {
                const std::uint64_t hash = hash_bits(seed, static_cast<std::uint64_t>(places.size()));
                places.emplace_back(static_cast<float>(x + upper_unit(hash)), static_cast<float>(y + lower_unit(hash)));
            }
    return places;
}

/// A heap of all points, the most crowded on top, in which a point's crowding can fall.
class CrowdingHeap {
public:
    explicit CrowdingHeap(std::vector<float> crowding)
        : crowding_(std::move(crowding)), heap_(crowding_.size()), slot_(crowding_.size()) {
        std::iota(heap_.begin(), heap_.end(), 0U);
        std::iota(slot_.begin(), slot_.end(), 0U);
        for (auto k = static_cast<std::uint32_t>(heap_.size() / 2); k-- > 0;) sink(k);
    }

    [[nodiscard]] std::size_t size() const { return heap_.size(); }
    [[nodiscard]] bool contains(std::uint32_t i) const { return slot_[i] != gone; }

    std::uint32_t pop() {
        const std::uint32_t top = heap_.front();
        put(0, heap_.back());
        heap_.pop_back();
        slot_[top] = gone;
        if (!heap_.empty()) sink(0);
        return top;
    }

    void lower(std::uint32_t i, float by) {
        crowding_[i] -= by;
        sink(slot_[i]);
    }

private:
    static constexpr std::uint32_t gone = 0xFFFFFFFF;

    void put(std::uint32_t slot, std::uint32_t i) {
        heap_[slot] = i;
        slot_[i] = slot;
    }
    void sink(std::uint32_t slot) {
        const std::uint32_t i = heap_[slot];
        while (true) {
            std::uint32_t child = 2 * slot + 1;
            if (child >= heap_.size()) break;
            if (child + 1 < heap_.size() && crowding_[heap_[child + 1]] > crowding_[heap_[child]]) ++child;
            if (crowding_[heap_[child]] <= crowding_[i]) break;
            put(slot, heap_[child]);
            slot = child;
        }
        put(slot, i);
    }

    std::vector<float> crowding_;
    std::vector<std::uint32_t> heap_;
    std::vector<std::uint32_t> slot_;
};

/// Takes the most crowded points away, one by one, until `target` are left; returns those taken, in that order.
/// - cells_per_point: share of the torus that a point has when it counts
std::vector<std::uint32_t> eliminate(const TorusPoints& points, std::size_t target, double cells_per_point) {
    // Twice the radius of disks that would cover the torus in the densest packing.
    const auto reach = static_cast<float>(2 * std::sqrt(cells_per_point / (2 * std::numbers::sqrt3)));
    const auto crowd = [reach](float distance) {
        const float closeness = 1 - distance / reach;
        const float square = closeness * closeness;
        return square * square * square * square;
    };
    std::vector<float> crowding(points.size(), 0);
    for (std::uint32_t i = 0; i < points.size(); ++i)
        points.for_each_near(i, reach,
                             [&](std::uint32_t, const V2f&, float distance) { crowding[i] += crowd(distance); });

    CrowdingHeap heap(std::move(crowding));
    std::vector<std::uint32_t> taken;
    while (heap.size() > target) {
        const std::uint32_t i = heap.pop();
        taken.push_back(i);
        points.for_each_near(i, reach, [&](std::uint32_t j, const V2f&, float distance) {
            if (heap.contains(j)) heap.lower(j, crowd(distance));
        });
    }
    return taken;
}

std::vector<bool> left_by(const std::vector<std::uint32_t>& taken, std::size_t count) {
    std::vector<bool> is_left(count, true);
    for (const std::uint32_t i : taken) is_left[i] = false;
    return is_left;
}

/// One point per cell of space, as evenly as elimination makes it.
TorusPoints even_points(int side, std::uint64_t seed) {
    constexpr int candidates_per_point = 3;  // more cost time and change nothing once the points are pushed apart
    const TorusPoints candidates(side, random_places(side, candidates_per_point, seed));
    const std::vector<bool> is_left =
        left_by(eliminate(candidates, static_cast<std::size_t>(side) * side, 1), candidates.size());
    std::vector<V2f> places;
    for (std::uint32_t i = 0; i < candidates.size(); ++i)
        if (is_left[i]) places.push_back(candidates[i]);
    return {side, places};
}

/// Points nearer than this, in root of a cell, push each other away. The densest lattice has 1.07; a tile near it would
/// be a crystal.
constexpr float push_distance = 0.87F;

TorusPoints pushed_apart(const TorusPoints& points) {
    constexpr float step = 0.3F;
    std::vector<V2f> places(points.size());
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        V2f push(0, 0);
        points.for_each_near(i, push_distance, [&](std::uint32_t, const V2f& difference, float distance) {
            if (distance > 0) push -= difference * ((push_distance - distance) / distance);
        });
        places[i] = points.wrapped(points[i] + push * step);
    }
    return {points.side(), places};
}

}  // namespace

BlueNoiseTile make_blue_noise_tile(int side, std::uint64_t seed) {
    constexpr int pushes = 10;
    TorusPoints points = even_points(side, seed);
    for (int k = 0; k < pushes; ++k) points = pushed_apart(points);

    // Below two fifths of the points nobody asks for an order.
    const std::uint32_t count = points.size();
    const std::vector<std::uint32_t> taken = eliminate(points, count * 2 / 5, 1.5);
    std::vector<float> ranks(count);
    const std::vector<bool> is_left = left_by(taken, count);
    for (std::uint32_t i = 0; i < count; ++i)
        if (is_left[i]) ranks[i] = static_cast<float>(0.4 * upper_unit(hash_bits(seed + 1, i)));
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
