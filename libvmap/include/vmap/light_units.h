// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the numbers of glTF's lights mean, after glTF-Blender-IO's lighting modes.
#pragma once

#include <numbers>

namespace vmap {

enum class LightUnits {
    compat,  ///< numbers as in the file: candela is W/sr, lux is W/m^2
    spec,    ///< photometric as the specification has it: divided by 683 lm/W
    raw      ///< Blender's watts as they stand: point and spot divided by 4 pi
};

/// Radiant intensity [W/sr] of one unit of a point's or spot's intensity in the file.
[[nodiscard]] constexpr double punctual_factor(LightUnits units) {
    if (units == LightUnits::spec) return 1 / 683.0;
    return units == LightUnits::raw ? 1 / (4 * std::numbers::pi) : 1;
}

/// Irradiance [W/m^2] of one unit of a directional light's intensity in the file.
[[nodiscard]] constexpr double directional_factor(LightUnits units) {
    return units == LightUnits::spec ? 1 / 683.0 : 1;
}

}  // namespace vmap
