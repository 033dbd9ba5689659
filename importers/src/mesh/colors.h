// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Colours as mesh and point formats have them.
#pragma once

#include "ply_header.h"

#include <Imath/ImathColor.h>

#include <vector>

namespace vmap {

/// Turns sRGB values as they stand in the file into linear light, in place. Whole numbers of 16 bits run to 65535,
/// other whole numbers to 255, floats to 1.
void decode_ply_colors(PlyType type, std::vector<Imath::C3f>& colors);

/// The same for a file that does not tell types: values run to 1 when none is above it, else to 255.
void decode_text_colors(std::vector<Imath::C3f>& colors);

}  // namespace vmap
