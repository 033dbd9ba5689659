// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Polygons of a mesh file as a Scene.
#pragma once

#include "mesh_file.h"

namespace vmap {

/// Triangulates, drops triangles without area, makes the winding consistent where the surface allows, and places one
/// mesh for each material that is used in the world. None of the formats says that a surface has only one side, so all
/// are double-sided.
///
/// - file: polygons with indices in range; its warnings grow
/// - returns a scene without instances when no triangle has an area
[[nodiscard]] Scene scene_from_soup(MeshFile& file);

}  // namespace vmap
