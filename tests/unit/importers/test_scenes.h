// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Small scenes in memory for tests.
#pragma once

#include <vmap/scene.h>

#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace vmap::test {

using Imath::M44d;
using Imath::V2f;
using Imath::V3d;
using Imath::V3f;

inline Scene scene_of(const Mesh& mesh, const Material& material = {}, const M44d& world_from_mesh = M44d()) {
    Scene scene;
    scene.source = "test";
    scene.meshes = {mesh};
    scene.materials = {material};
    scene.instances = {{.name = "one", .mesh = 0, .world_from_mesh = world_from_mesh}};
    return scene;
}

/// A rectangle in the plane z = 0 that faces +z, cut into columns x rows quads of two triangles; texture coordinates
/// run from 0 to 1 over it.
inline Mesh grid_mesh(float width, float height, int columns, int rows) {
    Mesh mesh;
    mesh.texcoords.resize(1);
    for (int y = 0; y <= rows; ++y)
        for (int x = 0; x <= columns; ++x) {
            const V2f place(static_cast<float>(x) / static_cast<float>(columns),
                            static_cast<float>(y) / static_cast<float>(rows));
            mesh.positions.emplace_back(place.x * width, place.y * height, 0.0F);
            mesh.texcoords[0].push_back(place);
        }
    const auto at = [&](int x, int y) { return static_cast<std::uint32_t>(y * (columns + 1) + x); };
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x)
            for (const std::uint32_t i :
                 {at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y), at(x + 1, y + 1), at(x, y + 1)})
                mesh.indices.push_back(i);
    return mesh;
}

/// A closed box from 0 to size whose fronts face outwards; no vertices are shared between its sides.
inline Mesh box_mesh(const V3f& size) {
    Mesh mesh;
    const auto quad = [&](const V3f& corner, const V3f& a, const V3f& b) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const V3f& p : {corner, corner + a, corner + a + b, corner + b}) mesh.positions.push_back(p);
        for (const std::uint32_t i : {0U, 1U, 2U, 0U, 2U, 3U}) mesh.indices.push_back(first + i);
    };
    const V3f x(size.x, 0, 0);
    const V3f y(0, size.y, 0);
    const V3f z(0, 0, size.z);
    quad(V3f(0), y, x);
    quad(z, x, y);
    quad(V3f(0), x, z);
    quad(y, z, x);
    quad(V3f(0), z, y);
    quad(x, y, z);
    return mesh;
}

/// A sphere of radius 1 about the origin, fronts outwards, with its true normals.
inline Mesh sphere_mesh(int columns, int rows) {
    Mesh mesh;
    for (int y = 0; y <= rows; ++y)
        for (int x = 0; x <= columns; ++x) {
            const double polar = std::numbers::pi * y / rows;
            const double around = 2 * std::numbers::pi * (x % columns) / columns;
            const V3f p(static_cast<float>(std::sin(polar) * std::cos(around)), static_cast<float>(std::cos(polar)),
                        static_cast<float>(-std::sin(polar) * std::sin(around)));
            mesh.positions.push_back(p);
            mesh.normals.push_back(p);
        }
    const auto at = [&](int x, int y) { return static_cast<std::uint32_t>(y * (columns + 1) + x); };
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
            if (y > 0)
                for (const std::uint32_t i : {at(x, y), at(x + 1, y + 1), at(x + 1, y)}) mesh.indices.push_back(i);
            if (y + 1 < rows)
                for (const std::uint32_t i : {at(x, y), at(x, y + 1), at(x + 1, y + 1)}) mesh.indices.push_back(i);
        }
    return mesh;
}

}  // namespace vmap::test
