// SPDX-License-Identifier: Apache-2.0
/// \file
/// What a scene's surface looks like at a place: geometry of its triangles in the world, albedo, emission, cut-outs.
/// The sampler, pictures of the scene and the reference for tests all ask here, so that they agree.
#pragma once

#include <vmap/scene.h>
#include <vmap/texture.h>

#include <Imath/ImathColor.h>
#include <Imath/ImathVec.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace vmap {

/// A place on a scene's surface.
struct SurfacePlace {
    std::size_t instance = 0;         ///< index into Scene::instances
    std::size_t triangle = 0;         ///< of the instance's mesh
    Imath::V3d barycentric{1.0 / 3};  ///< weights of the triangle's vertices in the order of the mesh; sum 1
    double width = 0;                 ///< world units: side of the square to average over; 0 for the place itself
};

/// The vertices of a triangle in the world, in the order of the mesh, whether or not the instance mirrors it.
[[nodiscard]] std::array<Imath::V3d, 3> world_triangle(const Scene& scene, std::size_t instance, std::size_t triangle);

/// True when the instance turns the winding around, so that the front is where the vertices run clockwise.
[[nodiscard]] bool is_mirrored(const Instance& instance);

/// Vector along the front's geometric normal, as long as twice the triangle's area; zero for a degenerate triangle.
[[nodiscard]] Imath::V3d world_area_normal(const Scene& scene, std::size_t instance, std::size_t triangle);

/// Faces are numbered over all instances in their order and the triangles of their meshes.
/// Returns the number of each instance's first face, and the total as one more element.
[[nodiscard]] std::vector<std::size_t> first_faces(const Scene& scene);

/// Looks up the materials of a scene. Keeps a reference to the scene, which must outlive it and not change.
/// All functions may be called from many threads at once.
class SurfaceShading {
public:
    /// Prepares the images that materials use.
    /// - scene: indices in range, as the importers deliver it
    explicit SurfaceShading(const Scene& scene);

    /// Diffuse reflectance before clamping: base colour x texture x vertex colour x (1 - metallic), linear Rec.709.
    [[nodiscard]] Imath::C3f albedo(const SurfacePlace& place) const;

    /// Emitted radiance of the front, W/(m^2 sr), linear Rec.709.
    [[nodiscard]] Imath::C3f emission(const SurfacePlace& place) const;

    /// Whether an alpha mask cuts the surface away at this very place; the width does not count.
    [[nodiscard]] bool is_cut(const SurfacePlace& place) const;

    /// Interpolated shading normal on the front's side, unit; the geometric one where the mesh has none.
    [[nodiscard]] Imath::V3d shading_normal(const SurfacePlace& place) const;

    [[nodiscard]] const Scene& scene() const { return *scene_; }
    [[nodiscard]] const Material& material(const SurfacePlace& place) const;

private:
    [[nodiscard]] const Mesh& mesh(const SurfacePlace& place) const;
    [[nodiscard]] Imath::C4f look_up(const TextureView& view, TexelMeaning meaning, const SurfacePlace& place) const;
    [[nodiscard]] TextureFootprint footprint(const std::vector<Imath::V2f>& texcoords, const SurfacePlace& place) const;
    void prepare(const TextureView& view, TexelMeaning meaning);

    const Scene* scene_;
    std::map<std::pair<std::size_t, TexelMeaning>, TexturePyramid> pyramids_;  ///< by image and meaning
};

}  // namespace vmap
