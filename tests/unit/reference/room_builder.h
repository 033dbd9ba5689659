// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Scenes of rectangles and boxes, made in a few lines of a test.
#pragma once

#include <vmap/scene.h>

#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

#include <utility>

namespace vmap::test {

/// A material of one albedo and one emission.
inline Material matte(const Imath::C3f& albedo, const Imath::C3f& emission = {0, 0, 0}) {
    Material material;
    material.base_color = {albedo.x, albedo.y, albedo.z, 1};
    material.emission = emission;
    return material;
}

inline Imath::C3f grey(float value) {
    return {value, value, value};
}

/// Collects meshes, one per call, each with its own material.
class RoomBuilder {
public:
    /// A parallelogram from a corner along two edges; its front is on the side of the cross product of first and
    /// second.
    RoomBuilder& quad(const Imath::V3f& corner, const Imath::V3f& first, const Imath::V3f& second,
                      const Material& material) {
        Mesh mesh;
        add_quad(mesh, corner, first, second);
        return place(std::move(mesh), material);
    }

    /// A box between two corners that shows its fronts outwards.
    RoomBuilder& box(const Imath::V3f& low, const Imath::V3f& high, const Material& material) {
        return place(box_mesh(low, high), material);
    }

    /// A box between two corners that shows its fronts inwards.
    RoomBuilder& room(const Imath::V3f& low, const Imath::V3f& high, const Material& material) {
        Mesh mesh = box_mesh(low, high);
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3) std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
        return place(std::move(mesh), material);
    }

    RoomBuilder& light(const LightSource& source) {
        scene_.lights.push_back(source);
        return *this;
    }

    RoomBuilder& place(Mesh mesh, const Material& material, const Imath::M44d& world_from_mesh = Imath::M44d()) {
        mesh.material = scene_.materials.size();
        scene_.materials.push_back(material);
        scene_.instances.push_back({.name = "part", .mesh = scene_.meshes.size(), .world_from_mesh = world_from_mesh});
        scene_.meshes.push_back(std::move(mesh));
        return *this;
    }

    /// The same scene somewhere else and of another size.
    RoomBuilder& transform(const Imath::M44d& matrix) {
        for (Instance& instance : scene_.instances) instance.world_from_mesh *= matrix;
        return *this;
    }

    [[nodiscard]] const Scene& scene() const { return scene_; }

private:
    static void add_quad(Mesh& mesh, const Imath::V3f& corner, const Imath::V3f& first, const Imath::V3f& second) {
        const auto base = static_cast<std::uint32_t>(mesh.positions.size());
        for (const Imath::V3f& p : {corner, corner + first, corner + first + second, corner + second})
            mesh.positions.push_back(p);
        for (const std::uint32_t i : {0U, 1U, 2U, 0U, 2U, 3U}) mesh.indices.push_back(base + i);
    }

    static Mesh box_mesh(const Imath::V3f& low, const Imath::V3f& high) {
        const Imath::V3f x(high.x - low.x, 0, 0);
        const Imath::V3f y(0, high.y - low.y, 0);
        const Imath::V3f z(0, 0, high.z - low.z);
        Mesh mesh;
        add_quad(mesh, low, y, x);
        add_quad(mesh, low + z, x, y);
        add_quad(mesh, low, x, z);
        add_quad(mesh, low + y, z, x);
        add_quad(mesh, low, z, y);
        add_quad(mesh, low + x, y, z);
        return mesh;
    }

    Scene scene_;
};

}  // namespace vmap::test
