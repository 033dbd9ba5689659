// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A picture as a PNG file: a preview for displays.
#pragma once

#include <vmap/exporters/file_writer.h>
#include <vmap/exporters/output_info.h>
#include <vmap/exporters/picture.h>

namespace vmap {

/// Writes 8-bit sRGB of exposure x radiance, clamped, over black where the picture has an alpha. Text chunks hold the
/// exposure, the version and the source.
///
/// Throws FileError, UsageError for a picture without pixels; the caller commits the file.
void write_png(FileWriter& file, const Picture& picture, const OutputInfo& info);

}  // namespace vmap
