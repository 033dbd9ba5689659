// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Colours that stand for numbers.
#pragma once

#include <array>
#include <cstdint>

namespace vmap {

/// sRGB from black over violet and orange to pale yellow, ever lighter, so that it reads in grey too.
/// - value: clamped to [0, 1]
[[nodiscard]] std::array<std::uint8_t, 3> error_color(double value);

}  // namespace vmap
