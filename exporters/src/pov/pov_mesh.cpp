// SPDX-License-Identifier: GPL-3.0-or-later
#include "pov_mesh.h"

#include "wrapped_image.h"

#include <vmap/error.h>
#include <vmap/exporters/output_info.h>
#include <vmap/printable.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

namespace vmap {
namespace {

using Imath::C4f;
using Imath::V2d;
using Imath::V2f;
using Imath::V3f;

bool is_finite(const V3f& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

[[noreturn]] void refuse(const std::string& path, const Mesh& mesh, const char* what, std::size_t vertex) {
    throw UnsupportedInput(fmt::format("{}: mesh '{}' has {} of vertex {} that is not finite", printable(path),
                                       header_text(mesh.name), what, vertex));
}

void write_positions(PovText& text, const Mesh& mesh, const PovMeshStyle& style, const std::string& path) {
    const std::size_t count = mesh.positions.size();
    text.line("vertex_vectors {{ {},", count);
    for (std::size_t i = 0; i < count; ++i) {
        V3f position = mesh.positions[i];
        if (!is_finite(position)) refuse(path, mesh, "a position", i);
        if (style.transform) position = V3f(Imath::V3d(position) * *style.transform);
        text.add("<{},{},{}>", position.x, position.y, position.z);
        text.end_element(i + 1 == count);
    }
    text.line("}}");
}

/// POV-Ray cannot shade with a normal that has no direction: such a mesh stays flat.
bool has_sound_normals(const Mesh& mesh) {
    return !mesh.normals.empty() && std::all_of(mesh.normals.begin(), mesh.normals.end(),
                                                [](const V3f& n) { return is_finite(n) && n.length2() > 0; });
}

void write_normals(PovText& text, const Mesh& mesh) {
    const std::size_t count = mesh.normals.size();
    text.line("normal_vectors {{ {},", count);
    for (std::size_t i = 0; i < count; ++i) {
        const V3f& normal = mesh.normals[i];
        text.add("<{},{},{}>", normal.x, normal.y, normal.z);
        text.end_element(i + 1 == count);
    }
    text.line("}}");
}

/// v runs upwards in POV-Ray.
void write_texcoords(PovText& text, const std::vector<V2d>& coordinates) {
    text.line("uv_vectors {{ {},", coordinates.size());
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
        text.add("<{},{}>", coordinates[i].x, 1 - coordinates[i].y);
        text.end_element(i + 1 == coordinates.size());
    }
    text.line("}}");
}

std::vector<V2d> image_coordinates(const Scene& scene, const Mesh& mesh, const TextureView& view,
                                   const std::string& path) {
    const Image& image = scene.images[view.image];
    const std::vector<V2f>& texcoords = mesh.texcoords[static_cast<std::size_t>(view.texcoord_set)];
    std::vector<V2d> coordinates(texcoords.size());
    for (std::size_t i = 0; i < texcoords.size(); ++i) {
        const V2d place = image_coordinate(view, texcoords[i]);
        if (!std::isfinite(place.x) || !std::isfinite(place.y)) refuse(path, mesh, "a texture coordinate", i);
        coordinates[i] = {extended_coordinate(view.wrap_u, place.x, image.width),
                          extended_coordinate(view.wrap_v, place.y, image.height)};
    }
    return coordinates;
}

std::vector<V2d> tile_coordinates(const Mesh& mesh, const TileLayout& layout) {
    std::vector<V2d> coordinates;
    for (std::size_t i = 0; i < mesh.triangle_count(); ++i)
        for (const V2d& corner : layout.corners(i)) coordinates.push_back(corner);
    return coordinates;
}

/// A texture for each different vertex colour; returns the texture of each vertex.
std::vector<std::size_t> write_vertex_textures(PovText& text, const Scene& scene, const Mesh& mesh) {
    const Material& material = scene.materials[mesh.material];
    std::map<std::array<float, 3>, std::size_t> textures;
    std::vector<std::size_t> texture_of_vertex;
    std::vector<Imath::C3f> colors;
    for (const C4f& vertex_color : mesh.colors) {
        const Imath::C3f albedo = plain_albedo(material, vertex_color);
        const auto [found, is_new] = textures.try_emplace({albedo.x, albedo.y, albedo.z}, textures.size());
        if (is_new) colors.push_back(albedo);
        texture_of_vertex.push_back(found->second);
    }
    text.line("texture_list {{ {},", colors.size());
    for (std::size_t i = 0; i < colors.size(); ++i) {
        const PovPigment pigment{.color = colors[i], .image = "", .nearest = false};
        text.add("texture {{ {} }}", texture_body(pigment, material.emission, ""));
        text.end_element(i + 1 == colors.size());
    }
    text.line("}}");
    return texture_of_vertex;
}

/// Vertices of a triangle in POV-Ray's order.
std::array<std::size_t, 3> corners_of(const Mesh& mesh, std::size_t triangle) {
    const std::uint32_t* first = &mesh.indices[3 * triangle];
    return {first[0], first[2], first[1]};
}

void write_faces(PovText& text, const Mesh& mesh, const std::vector<std::size_t>& texture_of_vertex) {
    const std::size_t count = mesh.triangle_count();
    text.line("face_indices {{ {},", count);
    for (std::size_t i = 0; i < count; ++i) {
        const auto [a, b, c] = corners_of(mesh, i);
        text.add("<{},{},{}>", a, b, c);
        if (!texture_of_vertex.empty())
            text.add(",{},{},{}", texture_of_vertex[a], texture_of_vertex[b], texture_of_vertex[c]);
        text.end_element(i + 1 == count);
    }
    text.line("}}");
}

void write_tile_faces(PovText& text, const Mesh& mesh) {
    const std::size_t count = mesh.triangle_count();
    text.line("uv_indices {{ {},", count);
    for (std::size_t i = 0; i < count; ++i) {
        text.add("<{},{},{}>", 3 * i, 3 * i + 2, 3 * i + 1);
        text.end_element(i + 1 == count);
    }
    text.line("}}");
}

}  // namespace

void write_mesh2(PovText& text, const Scene& scene, const Mesh& mesh, const PovMeshStyle& style,
                 const std::string& path) {
    text.line("mesh2 {{");
    write_positions(text, mesh, style, path);
    if (style.shading_normals && !style.transform && has_sound_normals(mesh)) write_normals(text, mesh);
    if (style.paint->kind == PaintKind::image)
        write_texcoords(text, image_coordinates(scene, mesh, style.paint->view, path));
    if (style.tiles) write_texcoords(text, tile_coordinates(mesh, *style.tiles));
    std::vector<std::size_t> texture_of_vertex;
    if (style.paint->kind == PaintKind::per_vertex) texture_of_vertex = write_vertex_textures(text, scene, mesh);
    write_faces(text, mesh, texture_of_vertex);
    if (style.tiles) write_tile_faces(text, mesh);
    // With a texture for each vertex this one never shows, but an interior texture asks for it.
    if (!style.texture.empty()) text.line("texture {{ {} }}", style.texture);
    if (!style.back_texture.empty()) text.line("interior_texture {{ {} }}", style.back_texture);
    text.line("}}");
}

}  // namespace vmap
