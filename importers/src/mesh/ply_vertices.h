// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The vertices of a PLY file: positions, normals, colours, texture coordinates, and what our own files add.
#pragma once

#include "mesh_file.h"
#include "ply_elements.h"

namespace vmap {

/// Reads the element "vertex" into file.soup, and into file.points when it describes lit points.
/// - throws BrokenContent for missing coordinates and for values that are not finite
void read_ply_vertices(const PlyHeader& header, const PlyElement& vertex, PlyElements& elements, MeshFile& file);

}  // namespace vmap
