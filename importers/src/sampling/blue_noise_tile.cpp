// SPDX-License-Identifier: GPL-3.0-or-later
#include "blue_noise_tile.h"

#include "random_numbers.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

namespace vmap {
namespace {

struct Candidate {
    float x, y;  ///< in cells of the tile
};

/// Candidates on a torus, by cell.
class Candidates {
public:
    Candidates(int side, int per_cell, std::uint64_t seed) : side_(side) {
        for (int cell = 0; cell < side * side; ++cell) {
            const int row = cell / side;
            const int column = cell % side;
            for (int k = 0; k < per_cell; ++k) {
                const std::uint64_t hash = hash_bits(seed, static_cast<std::uint64_t>(per_cell) * cell + k);
                places_.push_back(
                    {static_cast<float>(column + upper_unit(hash)), static_cast<float>(row + lower_unit(hash))});
            }
        }
        per_cell_ = per_cell;
    }

    [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(places_.size()); }
    [[nodiscard]] const Candidate& operator[](std::uint32_t i) const { return places_[i]; }

    /// Calls visit(other, squared distance) for every other candidate nearer than reach cells.
    template <class Visit>
    void for_each_near(std::uint32_t i, float reach, const Visit& visit) const {
        const int steps = static_cast<int>(std::ceil(reach));
        const auto cell = static_cast<int>(i) / per_cell_;
        const auto half = static_cast<float>(side_) / 2;
        for (int dy = -steps; dy <= steps; ++dy)
            for (int dx = -steps; dx <= steps; ++dx) {
                const int x = (cell % side_ + dx + side_) % side_;
                const int y = (cell / side_ + dy + side_) % side_;
                const int first = (y * side_ + x) * per_cell_;
                for (int k = first; k < first + per_cell_; ++k) {
                    if (k == static_cast<int>(i)) continue;
                    float ex = std::abs(places_[k].x - places_[i].x);
                    float ey = std::abs(places_[k].y - places_[i].y);
                    if (ex > half) ex = static_cast<float>(side_) - ex;
                    if (ey > half) ey = static_cast<float>(side_) - ey;
                    const float square = ex * ex + ey * ey;
                    if (square < reach * reach) visit(static_cast<std::uint32_t>(k), square);
                }
            }
    }

private:
    int side_;
    int per_cell_ = 1;
    std::vector<Candidate> places_;
};

/// A heap of candidates, the most crowded on top, in which a candidate's crowding can fall.
class CrowdingHeap {
public:
    CrowdingHeap(std::vector<float> crowding, const std::vector<std::uint32_t>& members)
        : crowding_(std::move(crowding)), heap_(members), slot_(crowding_.size(), gone) {
        for (std::uint32_t k = 0; k < heap_.size(); ++k) slot_[heap_[k]] = k;
        for (auto k = static_cast<std::uint32_t>(heap_.size() / 2); k-- > 0;) sink(k);
    }

    [[nodiscard]] std::size_t size() const { return heap_.size(); }
    [[nodiscard]] bool contains(std::uint32_t i) const { return slot_[i] != gone; }
    [[nodiscard]] const std::vector<std::uint32_t>& members() const { return heap_; }

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

/// Takes the most crowded candidates away, one by one, until `target` are left; returns those taken, in that order.
/// - members: left afterwards
std::vector<std::uint32_t> eliminate(const Candidates& candidates, std::vector<std::uint32_t>& members,
                                     std::size_t target, double cells_per_point) {
    // Twice the radius of disks that would cover the tile in the densest packing.
    const auto reach = static_cast<float>(2 * std::sqrt(cells_per_point / (2 * std::numbers::sqrt3)));
    const auto crowd = [reach](float square) {
        const float closeness = 1 - std::sqrt(square) / reach;
        const float power = closeness * closeness;
        return power * power * power * power;
    };
    std::vector<bool> is_member(candidates.size(), false);
    for (const std::uint32_t i : members) is_member[i] = true;
    std::vector<float> crowding(candidates.size(), 0);
    for (const std::uint32_t i : members)
        candidates.for_each_near(i, reach, [&](std::uint32_t j, float square) {
            if (is_member[j]) crowding[i] += crowd(square);
        });

    CrowdingHeap heap(std::move(crowding), members);
    std::vector<std::uint32_t> taken;
    while (heap.size() > target) {
        const std::uint32_t i = heap.pop();
        taken.push_back(i);
        candidates.for_each_near(i, reach, [&](std::uint32_t j, float square) {
            if (heap.contains(j)) heap.lower(j, crowd(square));
        });
    }
    members = heap.members();
    return taken;
}

}  // namespace

BlueNoiseTile make_blue_noise_tile(int side, std::uint64_t seed) {
    constexpr int candidates_per_cell = 5;
    const Candidates candidates(side, candidates_per_cell, seed);
    const std::size_t count = static_cast<std::size_t>(side) * side;
    std::vector<std::uint32_t> members(candidates.size());
    std::iota(members.begin(), members.end(), 0U);
    eliminate(candidates, members, count, 1);

    // Below two fifths of the points nobody asks for an order.
    const std::size_t ordered = count * 2 / 5;
    std::vector<std::uint32_t> left = members;
    std::vector<std::uint32_t> order = eliminate(candidates, left, ordered, 2);
    std::ranges::sort(left, {}, [seed](std::uint32_t i) { return hash_bits(seed + 1, i); });
    order.insert(order.end(), left.begin(), left.end());

    std::vector<float> rank(candidates.size());
    for (std::size_t k = 0; k < count; ++k)
        rank[order[k]] = static_cast<float>(static_cast<double>(count - 1 - k) / static_cast<double>(count));

    std::ranges::sort(members);  // candidates come cell by cell
    BlueNoiseTile tile{.side = side, .first = std::vector<std::uint32_t>(count + 1, 0), .points = {}};
    for (const std::uint32_t i : members) {
        const std::uint32_t cell = i / candidates_per_cell;
        const std::uint32_t row = cell / side;
        const std::uint32_t column = cell % side;
        ++tile.first[cell + 1];
        tile.points.push_back(
            {candidates[i].x - static_cast<float>(column), candidates[i].y - static_cast<float>(row), rank[i]});
    }
    std::partial_sum(tile.first.begin(), tile.first.end(), tile.first.begin());
    return tile;
}

}  // namespace vmap
