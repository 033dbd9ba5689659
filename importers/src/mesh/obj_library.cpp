// SPDX-License-Identifier: GPL-3.0-or-later
#include "obj_library.h"

#include "../content_error.h"
#include "mesh_file.h"
#include "text_cursor.h"

#include <tiny_obj_loader.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

namespace vmap {
namespace {

/// tinyobjloader does not tell whether Kd was given. A line before all others that no file would have says so.
std::string with_marked_colors(std::string_view text) {
    std::string marked;
    marked.reserve(text.size() + text.size() / 8);
    for (TextCursor lines(text); !lines.at_end(); lines.next_line()) {
        const std::string_view line = lines.rest_of_line();
        marked.append(line);
        marked += '\n';
        if (line.starts_with("newmtl")) marked += "Kd -1 -1 -1\n";
    }
    return marked;
}

std::string trimmed(std::string_view name) {
    return std::string(TextCursor(name).rest_of_line());
}

float usable(float value) {
    return std::isfinite(value) && value > 0 ? value : 0.0F;
}

Imath::C3f color_from(const float (&values)[3]) {
    return {usable(values[0]), usable(values[1]), usable(values[2])};
}

ObjTexture texture_from(const std::string& path, const tinyobj::texture_option_t& options) {
    ObjTexture texture;
    texture.path = trimmed(path);
    if (options.clamp) texture.view.wrap_u = texture.view.wrap_v = WrapMode::clamp_to_edge;
    // In the file v runs upwards: 1 - (scale * (1 - v) + offset).
    const double scale_v = options.scale[1];
    texture.view.image_from_texcoord = {
        {{options.scale[0], 0, options.origin_offset[0]}, {0, scale_v, 1 - scale_v - options.origin_offset[1]}}};
    return texture;
}

Imath::C4f base_color_from(const tinyobj::material_t& source) {
    const bool given = source.diffuse[0] >= 0 || source.diffuse[1] >= 0 || source.diffuse[2] >= 0;
    const float missing = source.diffuse_texname.empty() ? default_albedo : 1.0F;
    const Imath::C3f color = given ? color_from(source.diffuse) : Imath::C3f(missing, missing, missing);
    return {color.x, color.y, color.z, 1};
}

void warn_of_unmodelled(const tinyobj::material_t& source, Warnings& warnings) {
    const Imath::C3f specular = color_from(source.specular);
    if (specular.x + specular.y + specular.z > 0 || !source.specular_texname.empty())
        warnings.add("specular reflection (Ks, map_Ks) is not modelled", source.name);
    if (source.dissolve < 1 || !source.alpha_texname.empty())
        warnings.add("transparency (d, Tr, map_d) is not modelled: opaque", source.name);
    if (!source.bump_texname.empty() || !source.normal_texname.empty() || !source.displacement_texname.empty())
        warnings.add("bump, normal and displacement maps are not modelled", source.name);
    if (!source.metallic_texname.empty()) warnings.add("metallic maps (map_Pm) of MTL files are not read", source.name);
    if (!source.diffuse_texname.empty() && color_from(source.diffuse) == Imath::C3f(0, 0, 0) && source.diffuse[0] >= 0)
        warnings.add("Kd is black, so map_Kd shows nothing", source.name);
}

ObjMaterial material_from(const tinyobj::material_t& source, Warnings& warnings) {
    ObjMaterial result;
    Material& material = result.material;
    material.name = trimmed(source.name);
    material.base_color = base_color_from(source);
    material.emission = color_from(source.emission);
    material.metallic = std::min(usable(source.metallic), 1.0F);
    material.double_sided = true;
    result.color = texture_from(source.diffuse_texname, source.diffuse_texopt);
    result.emission = texture_from(source.emissive_texname, source.emissive_texopt);
    // An image of light without a colour for it is the light.
    if (!result.emission.path.empty() && !material.emits()) material.emission = {1, 1, 1};
    warn_of_unmodelled(source, warnings);
    return result;
}

}  // namespace

std::vector<ObjMaterial> read_obj_library(std::string_view text, Warnings& warnings) {
    if (text.find('\0') != text.npos) throw BrokenContent("holds zero bytes, expected text");
    std::map<std::string, int> numbers;
    std::vector<tinyobj::material_t> sources;
    std::istringstream stream(with_marked_colors(text));
    std::string complaints;
    tinyobj::LoadMtl(&numbers, &sources, &stream, &complaints, &complaints);

    std::vector<ObjMaterial> materials;
    for (const tinyobj::material_t& source : sources)
        if (!source.name.empty()) materials.push_back(material_from(source, warnings));
    return materials;
}

}  // namespace vmap
