// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A square of evenly spread points that repeats without seams, ranked: of any share of it, the points that come first
/// are evenly spread too.
///
/// This work is based on:
///   C. Yuksel, "Sample elimination for generating Poisson disk sample sets", Eurographics 2015 (the ranks).
#pragma once

#include <cstdint>
#include <vector>

namespace vmap {

struct BlueNoiseTile {
    struct Point {
        float x = 0;  ///< in its cell, in [0, 1)
        float y = 0;
        float rank = 0;  ///< in [0, 1): share of the tile's points that come before it
    };

    int side = 0;                      ///< cells along each side; a cell holds one point on average
    std::vector<std::uint32_t> first;  ///< point of each cell, row by row, and the number of points as one more
    std::vector<Point> points;         ///< side * side
};

/// - side: cells along each side, a multiple of 8
[[nodiscard]] BlueNoiseTile make_blue_noise_tile(int side, std::uint64_t seed);

}  // namespace vmap
