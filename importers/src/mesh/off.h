// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// OFF files: OFF, COFF, NOFF, STOFF and their combinations, as text.
///
/// Source: Geomview manual, "OFF: Object File Format".
#pragma once

#include "mesh_file.h"

#include <string_view>

namespace vmap {

/// - text: of the whole file; the first word may be missing, as in older files
/// - throws BrokenContent; UnsupportedContent for 4-dimensional, n-dimensional and binary files
[[nodiscard]] MeshFile read_off(std::string_view text);

}  // namespace vmap
