// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Image files made for tests by the libraries' own encoders.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace vmap::test {

/// A PNG of any colour type and depth that libpng knows. Indexed ones have the palette black, red, half-transparent
/// green.
///
/// - samples: row by row, packed as the format has it (16-bit samples high byte first)
[[nodiscard]] std::string png_file(int width, int height, int color_type, int bit_depth,
                                   const std::vector<std::uint8_t>& samples, bool interlaced = false);

/// A JPEG of best quality without subsampling.
///
/// - rgb: three bytes a pixel
[[nodiscard]] std::string jpeg_file(int width, int height, const std::vector<std::uint8_t>& rgb);

}  // namespace vmap::test
