// SPDX-License-Identifier: GPL-3.0-or-later
#include "obj_materials.h"

#include "../content_error.h"
#include "../decode_image.h"
#include "../file_bytes.h"

#include <algorithm>
#include <set>
#include <utility>

namespace vmap {
namespace {

constexpr std::uint64_t largest_library = std::uint64_t{64} << 20U;
constexpr std::uint64_t largest_image = std::uint64_t{1} << 30U;

std::string with_slashes(std::string_view path) {
    std::string result(path);
    std::replace(result.begin(), result.end(), '\\', '/');
    return result;
}

std::string folder_of(const std::string& path) {
    const std::size_t slash = path.rfind('/');
    return slash == path.npos ? std::string() : path.substr(0, slash + 1);
}

/// Splits at blanks, of which "\ " is part of a name.
std::vector<std::string> split_names(std::string_view names) {
    std::vector<std::string> result(1);
    for (std::size_t i = 0; i < names.size(); ++i) {
        const bool escaped = names[i] == '\\' && i + 1 < names.size() && names[i + 1] == ' ';
        if (escaped)
            result.back() += names[++i];
        else if (names[i] != ' ' && names[i] != '\t')
            result.back() += names[i];
        else if (!result.back().empty())
            result.emplace_back();
    }
    if (result.back().empty()) result.pop_back();
    return result;
}

}  // namespace

Material default_material(bool has_colors) {
    Material material;
    material.name = "default";
    if (!has_colors) material.base_color = {default_albedo, default_albedo, default_albedo, 1};
    material.double_sided = true;
    return material;
}

void ObjMaterials::load(std::string_view names, Warnings& warnings) {
    // The whole line may be one name; only if it is not, it is a list.
    const std::vector<std::string> list = split_names(names);
    if (list.size() > 1 && load_library(std::string(names), warnings)) return;
    bool found = false;
    for (const std::string& name : list) found = load_library(name, warnings) || found;
    // A list with one library that is there is taken as a choice.
    if (!found)
        for (const std::string& name : list)
            warnings.add("a material library cannot be read: its materials are grey", name);
}

bool ObjMaterials::load_library(std::string name, Warnings& warnings) {
    name = with_slashes(name);
    try {
        const Bytes bytes = read_file(folder_->find(name), largest_library);
        for (ObjMaterial& material : read_obj_library(as_text(bytes.span()), warnings)) {
            // Images are named from the library's folder.
            for (ObjTexture* texture : {&material.color, &material.emission})
                if (!texture->path.empty()) texture->path = folder_of(name) + with_slashes(texture->path);
            const std::string material_name = material.material.name;
            library_.emplace(material_name, std::move(material));
        }
        return true;
    } catch (const BrokenContent&) {
        return false;
    }
}

std::uint32_t ObjMaterials::use(std::string_view name) {
    const auto [known, is_new] = numbers_.try_emplace(std::string(name), static_cast<std::uint32_t>(used_.size() + 1));
    if (is_new) used_.emplace_back(name);
    return known->second;
}

Material ObjMaterials::resolve(const std::string& name, MeshFile& file) {
    const auto known = library_.find(name);
    if (known == library_.end()) {
        file.warnings.add("materials that no library defines are grey", name);
        Material material = default_material(!file.soup.colors.empty());
        material.name = name;
        return material;
    }
    Material material = known->second.material;
    material.base_color_texture = load_texture(known->second.color, file);
    material.emission_texture = load_texture(known->second.emission, file);
    return material;
}

std::optional<TextureView> ObjMaterials::load_texture(const ObjTexture& texture, MeshFile& file) {
    if (texture.path.empty()) return std::nullopt;
    const auto [known, is_new] = images_.try_emplace(texture.path);
    if (is_new) {
        try {
            const Bytes bytes = read_file(folder_->find(texture.path), largest_image);
            Image image = decode_image(bytes.span(), read_image_header(bytes.span()));
            image.name = texture.path;
            file.images.push_back(std::move(image));
            known->second = file.images.size() - 1;
        } catch (const std::runtime_error& error) {
            file.warnings.add("images that cannot be read are left out", texture.path + ": " + error.what());
        }
    }
    const std::optional<std::size_t> image = known->second;
    if (!image) return std::nullopt;
    TextureView view = texture.view;
    view.image = *image;
    return view;
}

void ObjMaterials::finish(MeshFile& file) {
    file.materials.push_back(default_material(!file.soup.colors.empty()));
    for (const std::string& name : used_) file.materials.push_back(resolve(name, file));
}

}  // namespace vmap
