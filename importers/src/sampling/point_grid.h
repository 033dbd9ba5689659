// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Places in space by cubic cells, for finding neighbours.
#pragma once

#include <Imath/ImathVec.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vmap {

/// Number of a cell; cells a million apart may share one.
[[nodiscard]] std::uint64_t cell_key(const Imath::V3i& cell);

/// The cell of a place in units of the cells' side.
[[nodiscard]] Imath::V3i cell_at(const Imath::V3f& place);

/// A hash table of cells and a number for each.
class CellTable {
public:
    static constexpr std::uint32_t none = 0xFFFFFFFF;

    /// - keys: without repeats; the number of a cell is its place among them
    explicit CellTable(std::span<const std::uint64_t> keys);

    [[nodiscard]] std::uint32_t find(std::uint64_t key) const {
        for (std::size_t slot = slot_of(key);; slot = (slot + 1) & mask_) {
            if (slots_[slot].number == none || slots_[slot].key == key) return slots_[slot].number;
        }
    }

private:
    struct Slot {
        std::uint64_t key = 0;
        std::uint32_t number = none;
    };
    [[nodiscard]] std::size_t slot_of(std::uint64_t key) const;

    std::size_t mask_;
    std::vector<Slot> slots_;
};

/// Places sorted by cell.
class PointGrid {
public:
    /// - places: in units of the cells' side
    explicit PointGrid(std::span<const Imath::V3f> places);

    /// Calls visit(number of the place) for all in the cell and the 26 around it.
    template <class Visit>
    void for_each_around(const Imath::V3f& place, const Visit& visit) const {
        const Imath::V3i center = cell_at(place);
        for (int z = -1; z <= 1; ++z)
            for (int y = -1; y <= 1; ++y)
                for (int x = -1; x <= 1; ++x) {
                    const std::uint32_t cell = table_.find(cell_key(center + Imath::V3i(x, y, z)));
                    if (cell == CellTable::none) continue;
                    for (std::uint32_t k = first_[cell]; k < first_[cell + 1]; ++k) visit(order_[k]);
                }
    }

private:
    std::vector<std::uint32_t> order_;  ///< places, cell by cell, lower numbers first
    std::vector<std::uint32_t> first_;  ///< of each cell
    CellTable table_;
};

}  // namespace vmap
