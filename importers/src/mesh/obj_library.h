// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// One material library (MTL) of an OBJ file, read by tinyobjloader.
#pragma once

#include "../warnings.h"

#include <vmap/scene.h>

#include <string>
#include <string_view>
#include <vector>

namespace vmap {

/// An image that a material names, and how surfaces look it up. The view's image is not set yet.
struct ObjTexture {
    std::string path;  ///< as in the file; empty: no image
    TextureView view;
};

/// Kd is the base colour, Ke the emitted radiance, Pm the metallic part.
struct ObjMaterial {
    Material material;    ///< named, without textures
    ObjTexture color;     ///< map_Kd
    ObjTexture emission;  ///< map_Ke
};

/// - text: of the whole library
/// - throws BrokenContent for text that is none
[[nodiscard]] std::vector<ObjMaterial> read_obj_library(std::string_view text, Warnings& warnings);

}  // namespace vmap
