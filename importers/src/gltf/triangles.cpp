// SPDX-License-Identifier: GPL-3.0-or-later
#include "triangles.h"

#include "../content_error.h"
#include "../warnings.h"
#include "accessor.h"
#include "linear_part.h"
#include "vertex_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vmap::gltf {
namespace {

using Imath::M44d;
using Imath::V3d;
using Imath::V3f;

/// Three vertices per triangle out of a list, a strip or a fan.
std::vector<std::uint32_t> corners_of(PrimitiveMode mode, std::vector<std::uint32_t> sequence, Buffers& buffers) {
    if (mode == PrimitiveMode::triangles) {
        sequence.resize(sequence.size() / 3 * 3);
        return sequence;
    }
    std::vector<std::uint32_t> corners;
    if (sequence.size() < 3) return corners;
    const std::size_t count = sequence.size() - 2;
    buffers.spend(3 * count, sizeof(std::uint32_t));
    corners.reserve(3 * count);
    for (std::size_t i = 0; i < count; ++i) {
        if (mode == PrimitiveMode::triangle_fan)
            corners.insert(corners.end(), {sequence[i + 1], sequence[i + 2], sequence[0]});
        else
            corners.insert(corners.end(), {sequence[i], sequence[i + 1 + i % 2], sequence[i + 2 - i % 2]});
    }
    return corners;
}

/// Sets of texture coordinates that a material looks at.
std::vector<std::size_t> texcoord_sets(const Document& document, const Primitive& primitive) {
    std::vector<std::size_t> sets;
    if (!primitive.material) return sets;
    const Material& material = document.materials[*primitive.material];
    for (const auto* view : {&material.base_color_texture, &material.metallic_texture, &material.emission_texture})
        if (*view) sets.push_back(static_cast<std::size_t>((*view)->texcoord_set));
    std::sort(sets.begin(), sets.end());
    sets.erase(std::unique(sets.begin(), sets.end()), sets.end());
    return sets;
}

void read_texcoords(const Document& document, const Primitive& primitive, VertexReader& reader, Warnings& warnings,
                    Mesh& mesh) {
    for (const std::size_t set : texcoord_sets(document, primitive)) {
        mesh.texcoords.resize(set + 1);
        mesh.texcoords[set] = reader.texcoords(set);
        if (mesh.texcoords[set].empty())
            warnings.add("textures are used where the mesh has no texture coordinates for them: one texel counts",
                         primitive.where);
    }
}

/// A zero vector stands for a normal that is not to be used.
void clear_bad_normals(std::vector<V3f>& normals, const std::string& where, Warnings& warnings) {
    bool bad = false;
    for (V3f& normal : normals) {
        const double squares = V3d(normal).length2();
        if (std::isfinite(squares) && squares > 0) continue;
        normal = V3f(0);
        bad = true;
    }
    if (bad) warnings.add("normals that are zero or not finite are replaced by those of the faces", where);
}

/// Moves vertices from the bind pose into the world.
void apply_skin(const std::vector<M44d>& matrices, Mesh& mesh) {
    std::size_t mirrored = 0;
    for (std::size_t i = 0; i < matrices.size(); ++i) {
        mesh.positions[i] = V3f(V3d(mesh.positions[i]) * matrices[i]);
        mirrored += volume_factor(matrices[i]) < 0 ? 1 : 0;
        if (!mesh.normals.empty()) mesh.normals[i] = V3f(transformed_normal(matrices[i], mesh.normals[i]).normalized());
    }
    if (2 * mirrored <= matrices.size()) return;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
}

}  // namespace

std::vector<M44d> joint_matrices(const Document& document, const SkinInfo& skin, Buffers& buffers) {
    const std::size_t count = skin.joints.size();
    buffers.spend(count, sizeof(M44d) + 16 * sizeof(float));
    std::vector<float> numbers;
    if (skin.inverse_bind_matrices) {
        Elements elements = open_accessor(document.accessors[*skin.inverse_bind_matrices], buffers);
        elements.count = count;
        while (!elements.replaced.empty() && elements.replaced.back() >= count) elements.replaced.pop_back();
        numbers.resize(16 * count);
        read_floats(elements, {}, 16, numbers);
    }
    std::vector<M44d> matrices;
    matrices.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        M44d joint_from_bind;
        if (!numbers.empty())
            for (int k = 0; k < 16; ++k) joint_from_bind[k / 4][k % 4] = numbers[16 * i + k];
        const M44d world_from_bind = joint_from_bind * document.nodes[skin.joints[i]].pose;
        for (int k = 0; k < 16; ++k)
            if (!std::isfinite(world_from_bind[k / 4][k % 4]))
                throw BrokenContent("a skin has a joint matrix that is not finite");
        matrices.push_back(world_from_bind);
    }
    return matrices;
}

std::optional<Mesh> read_triangles(const Document& document, const Primitive& primitive, const Pose& pose,
                                   Buffers& buffers, Warnings& warnings) {
    VertexReader reader(document, primitive, pose.weights, buffers);
    if (reader.stored_count() == 0) {
        warnings.add("primitives without positions are left out", primitive.where);
        return std::nullopt;
    }
    std::vector<std::uint32_t> sequence = reader.sequence();
    const PrimitiveMode mode = primitive.draco ? PrimitiveMode::triangles : primitive.mode;
    if (mode == PrimitiveMode::triangles ? sequence.size() % 3 != 0 : sequence.size() < 3)
        warnings.add("vertices that do not make a whole triangle are left out", primitive.where);

    Mesh mesh;
    mesh.indices = corners_of(mode, std::move(sequence), buffers);
    if (mesh.indices.empty()) return std::nullopt;
    reader.keep_used(mesh.indices);
    mesh.positions = reader.positions();
    mesh.normals = reader.normals();
    clear_bad_normals(mesh.normals, primitive.where, warnings);
    mesh.colors = reader.colors();
    read_texcoords(document, primitive, reader, warnings, mesh);
    if (!pose.joints.empty()) apply_skin(reader.blend(pose.joints), mesh);
    return mesh;
}

}  // namespace vmap::gltf
