// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// JPEG by libjpeg-turbo.
#pragma once

#include "decode_image.h"

namespace vmap {

[[nodiscard]] ImageHeader read_jpeg_header(std::span<const std::byte> file);

/// - image: of the size in the header, rgba allocated
void decode_jpeg(std::span<const std::byte> file, Image& image);

}  // namespace vmap
