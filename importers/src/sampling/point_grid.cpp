// SPDX-License-Identifier: GPL-3.0-or-later
#include "point_grid.h"

#include "random_numbers.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <bit>
#include <cmath>
#include <utility>

namespace vmap {
namespace {

/// Sorts places by cell; returns the cells in order and where each begins.
std::vector<std::uint64_t> sort_by_cell(std::span<const Imath::V3f> places, std::vector<std::uint32_t>& order,
                                        std::vector<std::uint32_t>& first) {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keyed(places.size());
    tbb::parallel_for(std::size_t{0}, places.size(),
                      [&](std::size_t i) { keyed[i] = {cell_key(cell_at(places[i])), static_cast<std::uint32_t>(i)}; });
    tbb::parallel_sort(keyed);
    std::vector<std::uint64_t> cells;
    for (std::uint32_t k = 0; k < keyed.size(); ++k) {
        if (cells.empty() || cells.back() != keyed[k].first) {
            cells.push_back(keyed[k].first);
            first.push_back(k);
        }
        order.push_back(keyed[k].second);
    }
    first.push_back(static_cast<std::uint32_t>(keyed.size()));
    return cells;
}

}  // namespace

std::uint64_t cell_key(const Imath::V3i& cell) {
    constexpr std::uint64_t bits = 0x1FFFFF;
    return (static_cast<std::uint64_t>(cell.x) & bits) << 42 | (static_cast<std::uint64_t>(cell.y) & bits) << 21 |
           (static_cast<std::uint64_t>(cell.z) & bits);
}

Imath::V3i cell_at(const Imath::V3f& place) {
    return {static_cast<int>(std::floor(place.x)), static_cast<int>(std::floor(place.y)),
            static_cast<int>(std::floor(place.z))};
}

CellTable::CellTable(std::span<const std::uint64_t> keys)
    : mask_(std::bit_ceil(2 * keys.size() + 1) - 1), slots_(mask_ + 1) {
    for (std::uint32_t number = 0; number < keys.size(); ++number) {
        std::size_t slot = slot_of(keys[number]);
        while (slots_[slot].number != none) slot = (slot + 1) & mask_;
        slots_[slot] = {keys[number], number};
    }
}

std::size_t CellTable::slot_of(std::uint64_t key) const {
    return hash_bits(key) & mask_;
}

PointGrid::PointGrid(std::span<const Imath::V3f> places) : table_(sort_by_cell(places, order_, first_)) {}

}  // namespace vmap
