// SPDX-License-Identifier: Apache-2.0
#include <vmap/surface_shading.h>

#include <algorithm>
#include <cmath>

namespace vmap {
namespace {

using Imath::C3f;
using Imath::C4f;
using Imath::V2d;
using Imath::V2f;
using Imath::V3d;

std::array<std::uint32_t, 3> vertices_of(const Mesh& mesh, std::size_t triangle) {
    const std::uint32_t* first = &mesh.indices[3 * triangle];
    return {first[0], first[1], first[2]};
}

/// Determinant of the linear part: the change of volume, negative for a mirror.
double volume_factor(const Imath::M44d& m) {
    const V3d x(m[0][0], m[0][1], m[0][2]);
    const V3d y(m[1][0], m[1][1], m[1][2]);
    const V3d z(m[2][0], m[2][1], m[2][2]);
    return x.dot(y.cross(z));
}

TexelMeaning color_meaning(const Material& material) {
    return material.alpha_mode == AlphaMode::mask ? TexelMeaning::cutout : TexelMeaning::color;
}

C4f vertex_color(const Mesh& mesh, const SurfacePlace& place) {
    if (mesh.colors.empty()) return {1, 1, 1, 1};
    const auto [a, b, c] = vertices_of(mesh, place.triangle);
    return mesh.colors[a] * static_cast<float>(place.barycentric.x) +
           mesh.colors[b] * static_cast<float>(place.barycentric.y) +
           mesh.colors[c] * static_cast<float>(place.barycentric.z);
}

}  // namespace

std::array<V3d, 3> world_triangle(const Scene& scene, std::size_t instance, std::size_t triangle) {
    const Instance& placed = scene.instances[instance];
    const Mesh& mesh = scene.meshes[placed.mesh];
    const auto [a, b, c] = vertices_of(mesh, triangle);
    return {V3d(mesh.positions[a]) * placed.world_from_mesh, V3d(mesh.positions[b]) * placed.world_from_mesh,
            V3d(mesh.positions[c]) * placed.world_from_mesh};
}

bool is_mirrored(const Instance& instance) {
    return volume_factor(instance.world_from_mesh) < 0;
}

V3d world_area_normal(const Scene& scene, std::size_t instance, std::size_t triangle) {
    const auto [a, b, c] = world_triangle(scene, instance, triangle);
    const V3d normal = (b - a).cross(c - a);
    return is_mirrored(scene.instances[instance]) ? -normal : normal;
}

std::vector<std::size_t> first_faces(const Scene& scene) {
    std::vector<std::size_t> first(scene.instances.size() + 1, 0);
    for (std::size_t i = 0; i < scene.instances.size(); ++i)
        first[i + 1] = first[i] + scene.meshes[scene.instances[i].mesh].triangle_count();
    return first;
}

SurfaceShading::SurfaceShading(const Scene& scene) : scene_(&scene) {
    std::vector<bool> used(scene.materials.size(), false);
    for (const Instance& instance : scene.instances) used[scene.meshes[instance.mesh].material] = true;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const Material& material = scene.materials[i];
        if (!used[i]) continue;
        if (material.base_color_texture) prepare(*material.base_color_texture, color_meaning(material));
        if (material.metallic_texture) prepare(*material.metallic_texture, TexelMeaning::data);
        if (material.emission_texture) prepare(*material.emission_texture, TexelMeaning::color);
    }
}

void SurfaceShading::prepare(const TextureView& view, TexelMeaning meaning) {
    pyramids_.try_emplace({view.image, meaning}, scene_->images[view.image], meaning);
}

const Mesh& SurfaceShading::mesh(const SurfacePlace& place) const {
    return scene_->meshes[scene_->instances[place.instance].mesh];
}

const Material& SurfaceShading::material(const SurfacePlace& place) const {
    return scene_->materials[mesh(place).material];
}

/// Texture coordinates run linearly over a triangle, so their gradient in the world carries a square of the surface to
/// a parallelogram of the texture.
TextureFootprint SurfaceShading::footprint(const std::vector<V2f>& texcoords, const SurfacePlace& place) const {
    const auto [a, b, c] = vertices_of(mesh(place), place.triangle);
    const V2d uv_a(texcoords[a]);
    const V2d uv_b(texcoords[b]);
    const V2d uv_c(texcoords[c]);
    TextureFootprint result;
    result.center = uv_a * place.barycentric.x + uv_b * place.barycentric.y + uv_c * place.barycentric.z;
    if (!(place.width > 0)) return result;

    const auto [p, q, r] = world_triangle(*scene_, place.instance, place.triangle);
    const V3d x_axis = (q - p).normalized();
    const double b_x = (q - p).length();
    const double c_x = (r - p).dot(x_axis);
    const double c_y = ((r - p) - x_axis * c_x).length();
    if (!(b_x > 0) || !(c_y > 0)) return result;
    const V2d per_x = (uv_b - uv_a) / b_x;
    const V2d per_y = ((uv_c - uv_a) - per_x * c_x) / c_y;
    result.axis_u = per_x * place.width;
    result.axis_v = per_y * place.width;
    return result;
}

C4f SurfaceShading::look_up(const TextureView& view, TexelMeaning meaning, const SurfacePlace& place) const {
    const Mesh& surface = mesh(place);
    const auto set = static_cast<std::size_t>(view.texcoord_set);
    const TexturePyramid& pyramid = pyramids_.at({view.image, meaning});
    if (set >= surface.texcoords.size() || surface.texcoords[set].empty()) return pyramid.at(view, V2d(0, 0));
    return pyramid.average(view, footprint(surface.texcoords[set], place));
}

C3f SurfaceShading::albedo(const SurfacePlace& place) const {
    const Material& surface = material(place);
    C4f color = surface.base_color * vertex_color(mesh(place), place);
    if (surface.base_color_texture) color *= look_up(*surface.base_color_texture, color_meaning(surface), place);
    float metallic = surface.metallic;
    if (surface.metallic_texture) metallic *= look_up(*surface.metallic_texture, TexelMeaning::data, place).b;
    return C3f(color.r, color.g, color.b) * (1 - metallic);
}

C3f SurfaceShading::emission(const SurfacePlace& place) const {
    const Material& surface = material(place);
    if (!surface.emits() || !surface.emission_texture) return surface.emission;
    const C4f color = look_up(*surface.emission_texture, TexelMeaning::color, place);
    return surface.emission * C3f(color.r, color.g, color.b);
}

bool SurfaceShading::is_cut(const SurfacePlace& place) const {
    const Material& surface = material(place);
    if (surface.alpha_mode != AlphaMode::mask) return false;
    SurfacePlace here = place;
    here.width = 0;
    float alpha = surface.base_color.a * vertex_color(mesh(place), place).a;
    if (surface.base_color_texture) alpha *= look_up(*surface.base_color_texture, TexelMeaning::cutout, here).a;
    return alpha < surface.alpha_cutoff;
}

V3d SurfaceShading::shading_normal(const SurfacePlace& place) const {
    const V3d geometric = world_area_normal(*scene_, place.instance, place.triangle).normalized();
    const Mesh& surface = mesh(place);
    if (surface.normals.empty()) return geometric;
    const auto [a, b, c] = vertices_of(surface, place.triangle);
    const V3d in_mesh = V3d(surface.normals[a]) * place.barycentric.x + V3d(surface.normals[b]) * place.barycentric.y +
                        V3d(surface.normals[c]) * place.barycentric.z;

    // Normals follow the cofactors: the inverse transpose up to a factor whose sign a mirror gives.
    const Imath::M44d& m = scene_->instances[place.instance].world_from_mesh;
    const V3d x(m[0][0], m[0][1], m[0][2]);
    const V3d y(m[1][0], m[1][1], m[1][2]);
    const V3d z(m[2][0], m[2][1], m[2][2]);
    V3d world = y.cross(z) * in_mesh.x + z.cross(x) * in_mesh.y + x.cross(y) * in_mesh.z;
    if (is_mirrored(scene_->instances[place.instance])) world = -world;
    const double length = world.length();
    return length > 0 ? world / length : geometric;
}

}  // namespace vmap
