// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// PNG and JPEG files as pictures. Files are told apart by their first bytes, and their size is known before they are
/// decoded, so that the caller can set a limit.
#pragma once

#include <vmap/scene.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace vmap {

enum class ImageFormat { png, jpeg };

struct ImageHeader {
    ImageFormat format = ImageFormat::png;
    int width = 0;
    int height = 0;

    [[nodiscard]] std::uint64_t pixels() const {
        return static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
    }
};

inline constexpr int largest_image_side = 1 << 16;             ///< pixels
inline constexpr std::uint64_t most_image_pixels = 1U << 26U;  ///< 8192 x 8192: 256 MiB decoded

/// - throws UnsupportedContent for other formats and for images above the limits, BrokenContent for a damaged header
[[nodiscard]] ImageHeader read_image_header(std::span<const std::byte> file);

/// Decodes a file whose header was read. Numbers are kept as they are: no colour profile and no gamma is applied,
/// 16-bit channels are rounded to 8.
///
/// - returns an image without a name
/// - throws BrokenContent for a damaged file, UnsupportedContent for colour models that are not RGB or grey
[[nodiscard]] Image decode_image(std::span<const std::byte> file, const ImageHeader& header);

}  // namespace vmap
