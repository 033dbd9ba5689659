// SPDX-License-Identifier: GPL-3.0-or-later
#include "lit_surface.h"

#include "lit_sides.h"
#include "random_numbers.h"

#include <vmap/error.h>

#include <Imath/ImathBox.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vmap {
namespace {

using Imath::V3d;
using Imath::V3f;

/// Whole numbers, so that places that floats hold exactly stay exact.
V3d rounded(const V3d& v) {
    return {std::round(v.x), std::round(v.y), std::round(v.z)};
}

/// Fills in the vertices and what comes from them: origin and extent.
void place_vertices(LitSurface& surface) {
    const Scene& scene = *surface.scene;
    for (const Instance& instance : scene.instances) {
        surface.first_vertices.push_back(surface.vertices.size());
        for (const V3f& position : scene.meshes[instance.mesh].positions)
            surface.vertices.push_back(V3d(position) * instance.world_from_mesh);
    }
    Imath::Box3d box;
    for (const V3d& vertex : surface.vertices) box.extendBy(vertex);
    if (box.isEmpty()) return;
    surface.origin = rounded(box.center());
    for (V3d& vertex : surface.vertices) vertex -= surface.origin;
    for (const V3d& corner : {box.min - surface.origin, box.max - surface.origin})
        for (int axis = 0; axis < 3; ++axis) surface.extent = std::max(surface.extent, std::abs(corner[axis]));
}

/// Points of the R2 sequence folded into a triangle: even at any count.
struct EvenPlaces {
    double u0, v0;

    explicit EvenPlaces(std::uint64_t key) {
        const std::uint64_t hash = hash_bits(key);
        u0 = upper_unit(hash);
        v0 = lower_unit(hash);
    }
    [[nodiscard]] Imath::V2d operator()(int i) const {
        double u = u0 + 0.7548776662466927 * i;
        double v = v0 + 0.5698402909980532 * i;
        u -= std::floor(u);
        v -= std::floor(v);
        return u + v < 1 ? Imath::V2d(u, v) : Imath::V2d(1 - u, 1 - v);
    }
};

/// Share of a triangle that a mask leaves.
double kept_share(const LitSurface& surface, const LitTriangle& triangle, const SurfaceShading& shading, double spacing,
                  std::uint64_t seed) {
    // A triangle the size of one point's share needs few looks: over many triangles their errors average out.
    constexpr double looks_per_point = 32;
    const int looks = static_cast<int>(std::clamp(looks_per_point * triangle.area / (spacing * spacing), 8.0, 1e8));
    const EvenPlaces places(hash_bits(seed, triangle.face));
    int kept = 0;
    for (int i = 0; i < looks; ++i) {
        const Imath::V2d uv = places(i);
        if (!shading.is_cut(surface.place(triangle, uv.x, uv.y, 0))) ++kept;
    }
    return static_cast<double>(kept) / looks;
}

}  // namespace

SurfacePlace LitSurface::place(const LitTriangle& triangle, double u, double v, double width) const {
    return {.instance = triangle.instance,
            .triangle = triangle.face - first_faces[triangle.instance],
            .barycentric = V3d(1 - u - v, u, v),
            .width = width};
}

LitSurface find_lit_surface(const Scene& scene, SampleSides sides) {
    LitSurface surface;
    surface.scene = &scene;
    surface.first_faces = first_faces(scene);
    if (surface.first_faces.back() > std::numeric_limits<std::int32_t>::max())
        throw UnsupportedInput(scene.source + ": has " + std::to_string(surface.first_faces.back()) +
                               " triangles, expected fewer than 2^31");
    place_vertices(surface);

    std::vector<std::uint8_t> lit = find_lit_sides(scene, sides, surface.origin);
    std::vector<LitTriangle> fronts(lit.size());
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const std::size_t first = surface.first_faces[i];
        const std::size_t material = scene.meshes[scene.instances[i].mesh].material;
        tbb::parallel_for(first, surface.first_faces[i + 1], [&](std::size_t face) {
            const V3d normal = world_area_normal(scene, i, face - first);
            const double length = normal.length();
            if (!(length > 0 && std::isfinite(length))) {
                lit[face] = 0;
                return;
            }
            fronts[face] = {.face = static_cast<std::uint32_t>(face),
                            .instance = static_cast<std::uint32_t>(i),
                            .surface = static_cast<std::uint32_t>(2 * material),
                            .normal = V3f(normal / length),
                            .area = length / 2};
        });
    }
    for (std::size_t face = 0; face < lit.size(); ++face) {
        if (lit[face] == 0) ++surface.degenerate_faces;
        if ((lit[face] & front_side) != 0) surface.triangles.push_back(fronts[face]);
    }
    for (std::size_t face = 0; face < lit.size(); ++face) {
        if ((lit[face] & back_side) == 0) continue;
        LitTriangle back = fronts[face];
        back.normal = -back.normal;
        ++back.surface;
        surface.triangles.push_back(back);
    }
    return surface;
}

void cut_masked_areas(LitSurface& surface, const SurfaceShading& shading, double spacing, std::uint64_t seed) {
    tbb::parallel_for(std::size_t{0}, surface.triangles.size(), [&](std::size_t i) {
        LitTriangle& triangle = surface.triangles[i];
        if (surface.is_masked(triangle)) triangle.area *= kept_share(surface, triangle, shading, spacing, seed);
    });
    std::erase_if(surface.triangles, [](const LitTriangle& triangle) { return !(triangle.area > 0); });
}

}  // namespace vmap
