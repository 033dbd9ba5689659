// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// PLY files: meshes, triangle strips and points, of any scalar type, as text or binary in both byte orders.
#pragma once

#include "mesh_file.h"

#include <string_view>

namespace vmap {

/// - text: of the whole file
/// - returns points of their own where the file has no faces but properties as our own files have them
/// - throws BrokenContent, UnsupportedContent
[[nodiscard]] MeshFile read_ply(std::string_view text);

}  // namespace vmap
