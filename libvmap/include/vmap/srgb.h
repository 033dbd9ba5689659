// SPDX-License-Identifier: Apache-2.0
/// \file
/// The sRGB transfer curve (IEC 61966-2-1) between encoded values, mostly 8-bit samples, and linear light.
#pragma once

#include <cstdint>

namespace vmap {

/// Linear light in [0, 1] of an 8-bit sRGB sample.
[[nodiscard]] float linear_from_srgb8(std::uint8_t sample);

/// Linear light in [0, 1] of an sRGB value; below 0 and NaN count as 0, above 1 as 1.
[[nodiscard]] float linear_from_srgb(float encoded);

/// The 8-bit sRGB sample nearest to linear light; below 0 and NaN give 0, above 1 gives 255.
[[nodiscard]] std::uint8_t srgb8_from_linear(float linear);

}  // namespace vmap
