// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Points on triangles before their attributes are looked up.
#pragma once

#include <Imath/ImathVec.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace vmap {

/// A place on a triangle: weights of its second and third vertex in units of 2^-32, exact enough for slivers.
struct PlacedPoint {
    std::uint32_t triangle = 0;  ///< index into LitSurface::triangles
    std::uint32_t u = 0;
    std::uint32_t v = 0;

    static constexpr double unit = 0x1p-32;
};

/// - uv: weights of the second and third vertex; clamped to [0, 1)
[[nodiscard]] inline PlacedPoint placed_point(std::uint32_t triangle, const Imath::V2d& uv) {
    const auto fixed = [](double weight) {
        return static_cast<std::uint32_t>(std::clamp(weight * 0x1p32, 0.0, 0x1p32 - 1));
    };
    return {triangle, fixed(uv.x), fixed(uv.y)};
}

struct Placement {
    std::vector<PlacedPoint> points;
    std::vector<float> areas;  ///< of each point, world units squared
};

}  // namespace vmap
