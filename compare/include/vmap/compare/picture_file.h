// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// EXR and PNG files as pictures in linear light.
#pragma once

#include <vmap/exporters/picture.h>

#include <filesystem>

namespace vmap {

/// Reads the colours of an OpenEXR file (channels R, G, B of any type, or Y alone) or of a PNG file (decoded from sRGB,
/// or as its gamma says; over black where it is transparent). The format is told by the content. Other channels, and an
/// EXR file's alpha, are left aside: its colours are premultiplied.
///
/// Throws FileError for a file that cannot be read, is empty or broken, or holds values that are not finite;
/// UnsupportedInput for other formats and for EXR files without colours.
[[nodiscard]] Picture read_picture(const std::filesystem::path& file);

/// Whether a file starts as an EXR or PNG file does. Throws FileError when it cannot be read.
[[nodiscard]] bool is_picture(const std::filesystem::path& file);

}  // namespace vmap
