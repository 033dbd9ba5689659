// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The materials that an OBJ file names, with their images.
#pragma once

#include "../scene_folder.h"
#include "mesh_file.h"
#include "obj_library.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vmap {

/// Follows the mtllib and usemtl statements of one file. What cannot be found costs a warning, not the file.
class ObjMaterials {
public:
    /// - folder: where libraries and images are searched
    explicit ObjMaterials(const SceneFolder& folder) : folder_(&folder) {}

    /// Reads the libraries of a mtllib statement.
    /// - names: one name with blanks, or several between blanks, of which "\ " is part of a name
    void load(std::string_view names, Warnings& warnings);

    /// The number of the material that a usemtl statement names. 0 is for faces without any.
    [[nodiscard]] std::uint32_t use(std::string_view name);

    /// Puts the materials that were used and their images into the file.
    void finish(MeshFile& file);

private:
    /// False when the library cannot be read.
    bool load_library(std::string name, Warnings& warnings);
    [[nodiscard]] Material resolve(const std::string& name, MeshFile& file);
    [[nodiscard]] std::optional<TextureView> load_texture(const ObjTexture& texture, MeshFile& file);

    const SceneFolder* folder_;
    std::map<std::string, ObjMaterial, std::less<>> library_;
    std::map<std::string, std::uint32_t, std::less<>> numbers_;
    std::vector<std::string> used_;
    std::map<std::string, std::optional<std::size_t>> images_;  ///< by path; nothing for one that cannot be read
};

/// The material of faces without any.
/// - has_colors: the vertices or faces have colours that are the albedo
[[nodiscard]] Material default_material(bool has_colors);

}  // namespace vmap
