// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Pictures and maps of numbers as bytes that a page can show.
#pragma once

#include <vmap/exporters/picture.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace vmap {

/// 3 * width * height bytes, sRGB, rows from the top.
struct ShownPicture {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgb;
};

/// Exposure under which nineteen of twenty pixels of a picture do not clip.
[[nodiscard]] double exposure_for(const Picture& picture);

/// The picture's radiance times the exposure, clamped.
[[nodiscard]] ShownPicture shown_picture(const Picture& picture, double exposure);

/// Values from 0 to `top` as colours; a value below 0 means that there is none and becomes grey.
[[nodiscard]] ShownPicture shown_map(int width, int height, std::span<const double> values, double top);

/// The colours of a map in their order, one pixel high.
[[nodiscard]] ShownPicture shown_scale();

/// An end for a scale: the next larger of 1, 2, 5, 10, ... of a power of ten; 1 for what is not positive.
[[nodiscard]] double scale_end(double value);

/// The contents of a PNG file.
[[nodiscard]] std::string png_bytes(const ShownPicture& picture);

/// A PNG file as a data URI.
[[nodiscard]] std::string png_data_uri(const ShownPicture& picture);

}  // namespace vmap
