// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The lit sides of a scene's triangles: what points are spread over.
#pragma once

#include <vmap/importers/sample_surface.h>
#include <vmap/scene.h>
#include <vmap/surface_shading.h>

#include <Imath/ImathVec.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vmap {

/// One lit side of one triangle.
struct LitTriangle {
    std::uint32_t face = 0;      ///< numbered over all instances
    std::uint32_t instance = 0;  ///< index into Scene::instances
    std::uint32_t surface = 0;   ///< 2 * material, 1 more for the back
    Imath::V3f normal{0, 0, 1};  ///< geometric, unit, towards the lit side
    double area = 0;             ///< without what an alpha mask cuts away, world units squared

    [[nodiscard]] std::uint32_t material() const { return surface / 2; }
    [[nodiscard]] bool is_back() const { return surface % 2 == 1; }
};

/// Keeps a reference to the scene, which must outlive it.
struct LitSurface {
    const Scene* scene = nullptr;
    std::vector<std::size_t> first_faces;     ///< of each instance, as first_faces() gives them
    Imath::V3d origin{0, 0, 0};               ///< middle of the scene's box, whole numbers
    std::vector<Imath::V3d> vertices;         ///< of all instances, relative to the origin
    std::vector<std::size_t> first_vertices;  ///< of each instance
    std::vector<LitTriangle> triangles;
    std::size_t degenerate_faces = 0;  ///< faces that were left out because they have no area
    double extent = 0;                 ///< largest distance of a vertex from the origin along an axis

    /// Vertices relative to the origin, in the order of the mesh.
    [[nodiscard]] std::array<Imath::V3d, 3> corners(const LitTriangle& triangle) const {
        const Mesh& mesh = scene->meshes[scene->instances[triangle.instance].mesh];
        const std::uint32_t* index =
            &mesh.indices[3 * static_cast<std::size_t>(triangle.face - first_faces[triangle.instance])];
        const Imath::V3d* first = &vertices[first_vertices[triangle.instance]];
        return {first[index[0]], first[index[1]], first[index[2]]};
    }

    [[nodiscard]] bool is_masked(const LitTriangle& triangle) const {
        return scene->materials[triangle.material()].alpha_mode == AlphaMode::mask;
    }

    /// A place on a triangle for SurfaceShading.
    /// - u, v: weights of the triangle's second and third vertex
    [[nodiscard]] SurfacePlace place(const LitTriangle& triangle, double u, double v, double width) const;
};

/// Throws UnsupportedInput for a scene with more faces than 31 bits count.
[[nodiscard]] LitSurface find_lit_surface(const Scene& scene, SampleSides sides);

/// Takes what alpha masks cut away from the areas; triangles of which nothing is left are removed.
/// - spacing: rough mean distance of the points to come, world units: sets how closely one looks
void cut_masked_areas(LitSurface& surface, const SurfaceShading& shading, double spacing, std::uint64_t seed);

}  // namespace vmap
