// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Wavefront OBJ files with their material libraries.
///
/// Source: Alias|Wavefront, "Advanced Visualizer", appendix B1 (OBJ) and B2 (MTL), 1991; colours behind the coordinates
/// of a vertex as later scanners and modellers write them.
#pragma once

#include "../scene_folder.h"
#include "mesh_file.h"

#include <string_view>

namespace vmap {

/// - text: of the whole file
/// - folder: of the file; material libraries and images are searched there and nowhere else
/// - throws BrokenContent
[[nodiscard]] MeshFile read_obj(std::string_view text, const SceneFolder& folder);

}  // namespace vmap
