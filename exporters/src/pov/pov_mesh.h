// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Meshes as POV-Ray's mesh2.
#pragma once

#include "paint.h"
#include "paint_image.h"
#include "pov_text.h"

#include <optional>
#include <string>

namespace vmap {

/// What a mesh2 is written with beside its triangles.
struct PovMeshStyle {
    const Paint* paint = nullptr;
    std::optional<TileLayout> tiles;  ///< of a tiled paint
    std::string texture;              ///< name of the declared texture
    std::string back_texture;         ///< name of the declared texture of backs; empty: the same as in front
    bool shading_normals = false;
    std::optional<Imath::M44d> transform;  ///< applied to the vertices; empty: they stay in the mesh's own frame
};

/// Writes `mesh2 { ... }`. POV-Ray takes the side from which vertices run clockwise for the outside in right-handed
/// coordinates, so triangles are written the other way round.
///
/// - mesh: at least one triangle
/// - throws UnsupportedInput for positions or texture coordinates that are not finite; path names the file
void write_mesh2(PovText& text, const Scene& scene, const Mesh& mesh, const PovMeshStyle& style,
                 const std::string& path);

}  // namespace vmap
