// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Pictures inside texts.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace vmap {

/// A PNG file as a data URI.
/// - rgb: 3 * width * height bytes, sRGB, rows from the top
[[nodiscard]] std::string png_data_uri(int width, int height, std::span<const std::uint8_t> rgb);

}  // namespace vmap
