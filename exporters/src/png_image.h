// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// PNG files of raw samples.
#pragma once

#include <vmap/exporters/file_writer.h>

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace vmap {

/// Samples as they stand in a PNG file: rows from the top, sRGB.
struct PngImage {
    int width = 0;
    int height = 0;
    int channels = 3;         ///< 3: red, green, blue; 4: alpha too, not premultiplied
    int bits_per_sample = 8;  ///< 8, or 16 with the high byte first
    std::span<const std::uint8_t> bytes;
    std::vector<std::pair<std::string, std::string>> texts;  ///< keyword and value, printable
};

/// Throws FileError; the caller commits the file.
void write_png_image(FileWriter& file, const PngImage& image);

}  // namespace vmap
