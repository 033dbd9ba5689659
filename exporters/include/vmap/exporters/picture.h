// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A picture in linear light.
#pragma once

#include <Imath/ImathColor.h>

#include <cstddef>
#include <vector>

namespace vmap {

/// Radiance of each pixel, rows from the top.
struct Picture {
    int width = 0;
    int height = 0;
    std::vector<Imath::C3f> pixels;  ///< width * height, W/(m^2 sr), linear Rec.709
    std::vector<float> alpha;        ///< share of the pixel that surface covers, in [0, 1]; empty: all of it

    [[nodiscard]] const Imath::C3f& at(int x, int y) const {
        return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
    }
};

}  // namespace vmap
