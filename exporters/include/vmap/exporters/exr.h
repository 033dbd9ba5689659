// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A picture in linear light as an OpenEXR file.
#pragma once

#include <vmap/exporters/file_writer.h>
#include <vmap/exporters/output_info.h>
#include <vmap/exporters/picture.h>

namespace vmap {

/// Writes the channels R, G, B as 32-bit floats, unclamped and without exposure, and A when the picture has an alpha
/// (colours are premultiplied in both). The header's attributes hold light_units with its two factors, exposure, vmap
/// with the version, and source.
///
/// Throws FileError, UsageError for a picture without pixels; the caller commits the file.
void write_exr(FileWriter& file, const Picture& picture, const OutputInfo& info);

}  // namespace vmap
