// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Scenes with light that is known in closed form, and points on them, for tests of pictures.
#pragma once

#include <vmap/point_cloud.h>
#include <vmap/scene.h>
#include <vmap/surface_shading.h>

#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>

namespace vmap::test {

/// Irradiance at a world place with a normal.
using LightField = std::function<Imath::C3f(const Imath::V3d&, const Imath::V3d&)>;

/// Adds a mesh with a material of its own.
inline void add(Scene& scene, Mesh mesh, const Material& material = {}, const Imath::M44d& world_from_mesh = {}) {
    mesh.material = scene.materials.size();
    scene.instances.push_back({.name = "part", .mesh = scene.meshes.size(), .world_from_mesh = world_from_mesh});
    scene.materials.push_back(material);
    scene.meshes.push_back(std::move(mesh));
}

/// Evenly spread points on the fronts of a scene (both sides of double-sided materials), about `spacing` apart.
inline LitCloud lit_points(const Scene& scene, double spacing, const LightField& light) {
    const SurfaceShading shading(scene);
    LitCloud cloud;
    PointCloud& points = cloud.points;
    const double share = spacing * spacing;
    std::size_t face = 0;
    double owed = 0.5 * share;  // area that has no point yet: small triangles share points
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
        const Material& material = scene.materials[mesh.material];
        for (std::size_t t = 0; t < mesh.triangle_count(); ++t, ++face) {
            const std::array<Imath::V3d, 3> corners = world_triangle(scene, i, t);
            const Imath::V3d area_normal = world_area_normal(scene, i, t);
            const double area = area_normal.length() / 2;
            if (!(area > 0)) continue;
            owed += area;
            const auto count = static_cast<std::size_t>(std::max(0.0, std::floor(owed / share)));
            owed -= share * static_cast<double>(count);
            for (const double side : {1.0, -1.0}) {
                if (side < 0 && !material.double_sided) continue;
                for (std::size_t k = 0; k < count; ++k) {
                    // The R2 sequence, folded into the triangle: even without being regular.
                    const double index = static_cast<double>(k + 1);
                    double b = std::fmod(0.5 + 0.7548776662466927 * index, 1.0);
                    double c = std::fmod(0.5 + 0.5698402909980532 * index, 1.0);
                    if (b + c > 1) {
                        b = 1 - b;
                        c = 1 - c;
                    }
                    const Imath::V3d place = corners[0] * (1 - b - c) + corners[1] * b + corners[2] * c;
                    const Imath::V3d normal = area_normal.normalized() * side;
                    const SurfacePlace on_scene{i, t, {1 - b - c, b, c}, spacing};
                    points.positions.emplace_back(place);
                    points.normals.emplace_back(normal);
                    points.areas.push_back(static_cast<float>(share));
                    points.albedo.push_back(shading.albedo(on_scene));
                    points.emission.push_back(shading.emission(on_scene));
                    points.faces.push_back(static_cast<std::uint32_t>(face));
                    points.materials.push_back(static_cast<std::uint32_t>(mesh.material));
                    cloud.irradiance.push_back(light(place, normal));
                }
            }
        }
    }
    return cloud;
}

/// A camera at a place that looks at another, +Y up.
inline Camera looking(const Imath::V3d& from, const Imath::V3d& to, double vertical_fov = 0.8) {
    const Imath::V3d backward = (from - to).normalized();
    const Imath::V3d hint = std::abs(backward.y) < 0.99 ? Imath::V3d(0, 1, 0) : Imath::V3d(0, 0, -1);
    const Imath::V3d right = hint.cross(backward).normalized();
    const Imath::V3d up = backward.cross(right);
    Camera camera;
    camera.vertical_fov = vertical_fov;
    camera.world_from_camera = Imath::M44d(right.x, right.y, right.z, 0, up.x, up.y, up.z, 0, backward.x, backward.y,
                                           backward.z, 0, from.x, from.y, from.z, 1);
    return camera;
}

}  // namespace vmap::test
