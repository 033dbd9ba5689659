// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// PNG by libpng.
#pragma once

#include "decode_image.h"

namespace vmap {

[[nodiscard]] ImageHeader read_png_header(std::span<const std::byte> file);

/// - image: of the size in the header, rgba allocated
void decode_png(std::span<const std::byte> file, Image& image);

}  // namespace vmap
