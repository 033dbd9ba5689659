// SPDX-License-Identifier: GPL-3.0-or-later
#include <vmap/compare/error_colors.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace vmap {

std::array<std::uint8_t, 3> error_color(double value) {
    // Steps of equal lightness.
    static constexpr std::array<std::array<double, 3>, 8> stops{{{0, 0, 4},
                                                                 {32, 17, 80},
                                                                 {85, 22, 125},
                                                                 {144, 44, 127},
                                                                 {205, 64, 104},
                                                                 {247, 112, 85},
                                                                 {254, 178, 116},
                                                                 {252, 250, 186}}};
    const double place = std::clamp(value, 0.0, 1.0) * (stops.size() - 1);
    const std::size_t below = std::min(static_cast<std::size_t>(place), stops.size() - 2);
    const double t = place - static_cast<double>(below);
    std::array<std::uint8_t, 3> color{};
    for (std::size_t c = 0; c < 3; ++c)
        color[c] = static_cast<std::uint8_t>(std::lround(stops[below][c] * (1 - t) + stops[below + 1][c] * t));
    return color;
}

}  // namespace vmap
