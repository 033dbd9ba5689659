// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The filters of FLIP: what an eye at a distance blurs away, and what it notices as edges and points.
#pragma once

#include <cstddef>
#include <vector>

namespace vmap {

/// One channel of a picture.
struct Plane {
    int width = 0;
    int height = 0;
    std::vector<float> values;

    Plane(int w, int h) : width(w), height(h), values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
};

/// Contrast sensitivity of the eye for a channel of colour.
enum class EyeChannel { achromatic, red_green, blue_yellow };

/// The channel as blurred by the eye; beyond its border a picture goes on as it ends.
[[nodiscard]] Plane seen_by_eye(const Plane& plane, EyeChannel channel, double pixels_per_degree);

enum class Feature { edge, point };

/// Strength of a feature at each pixel.
/// - plane: achromatic, from 0 to 1
[[nodiscard]] Plane feature_strength(const Plane& plane, Feature feature, double pixels_per_degree);

}  // namespace vmap
