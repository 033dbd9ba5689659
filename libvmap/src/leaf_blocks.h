// SPDX-License-Identifier: Apache-2.0
/// \file
/// The rule `centroid` for up to 64 x 64 pairs of leaves at once: the same arithmetic as leaf_visibility.h, many
/// columns at a time.
#pragma once

#include "occluders.h"

#include <vmap/leaf_ranges.h>
#include <vmap/leaf_visibility.h>

#include <array>
#include <cstdint>
#include <vector>

namespace vmap {

/// Leaves, one array per attribute, with spare elements behind the last so that whole vectors can be read anywhere.
struct LeafArrays {
    explicit LeafArrays(const LeafVisibility& leaves);

    std::array<std::vector<float>, 3> centroid;
    std::array<std::vector<float>, 3> normal;
    std::vector<float> offset;
    std::vector<float> slab;
};

/// Which of two short ranges of leaves may still see which.
struct LeafBlock {
    static constexpr std::size_t width = 64;

    LeafRange rows;                         ///< at most width, all before the columns
    LeafRange columns;                      ///< at most width
    std::array<std::uint64_t, width> bits;  ///< one word a row, one bit a column

    [[nodiscard]] std::uint64_t all_columns() const {
        return columns.size() == width ? ~std::uint64_t{0} : (std::uint64_t{1} << columns.size()) - 1;
    }
};

/// Sets the bits of the pairs that face each other.
void keep_facing(const LeafArrays& leaves, LeafBlock& block);

/// Clears the bits of the pairs that an occluder blocks; on a uniform tree only where the disc's leaf is on the walk.
///
/// - returns whether any bit is left
bool clear_behind(const LeafArrays& leaves, const WallOccluder& wall, LeafBlock& block);
bool clear_behind(const LeafArrays& leaves, const LoneDisc& disc, const LeafVisibility& visibility, LeafBlock& block);

}  // namespace vmap
