// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The triangles of a scene in the world, and rays through them, by Embree.
#pragma once

#include <vmap/surface_shading.h>

#include <Imath/ImathVec.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace vmap::reference {

/// A place where a ray meets surface.
struct RayHit {
    std::uint32_t face = 0;
    SurfacePlace place;
    Imath::V3d position{0, 0, 0};  ///< in the frame of RayScene
    Imath::V3d normal{0, 0, 0};    ///< unit, of the side that the ray came from
    bool lit_side = false;         ///< the front, or either side of a double-sided surface
};

/// A scene's triangles about the middle of their box, so that scenes far from the origin lose nothing in Embree's
/// floats. Positions are in that frame, in world units. Functions may be called from many threads at once.
class RayScene {
public:
    /// The scene must outlive this and not change.
    explicit RayScene(const Scene& scene);
    ~RayScene();
    RayScene(const RayScene&) = delete;
    RayScene& operator=(const RayScene&) = delete;

    [[nodiscard]] const SurfaceShading& shading() const { return shading_; }
    [[nodiscard]] const Imath::V3d& origin() const { return origin_; }  ///< of the frame, in the world
    /// Step off a face that clears the rounding of Embree's floats there; without a face, anywhere in the scene.
    [[nodiscard]] double offset(std::uint32_t face) const { return offsets_[face]; }
    [[nodiscard]] double offset() const { return offset_; }
    [[nodiscard]] std::size_t face_count() const { return instance_of_face_.size(); }

    [[nodiscard]] SurfacePlace place(std::uint32_t face, const Imath::V3d& barycentric) const;
    [[nodiscard]] std::array<Imath::V3d, 3> triangle(std::uint32_t face) const;
    [[nodiscard]] Imath::V3d front_normal(std::uint32_t face) const { return normals_[face]; }

    /// First surface along a ray. Of sheets in one place it is the one that emits towards the ray, else one whose lit
    /// side faces the ray, else any.
    /// - direction: unit
    [[nodiscard]] std::optional<RayHit> first_hit(const Imath::V3d& origin, const Imath::V3d& direction) const;

    /// Whether surface lies between two positions, the ends themselves excluded as far as rounding reaches.
    [[nodiscard]] bool is_blocked(const Imath::V3d& from, const Imath::V3d& to) const;

    /// Whether surface lies along a ray. direction: unit
    [[nodiscard]] bool is_blocked_to_infinity(const Imath::V3d& from, const Imath::V3d& direction) const;

private:
    struct Embree;
    [[nodiscard]] bool is_lit_side(std::uint32_t face, bool front) const;

    SurfaceShading shading_;
    Imath::V3d origin_{0, 0, 0};
    double offset_ = 0;
    std::vector<std::size_t> first_faces_;
    std::vector<std::uint32_t> instance_of_face_;
    std::vector<Imath::V3f> vertices_;
    std::vector<std::array<std::uint32_t, 3>> triangles_;
    std::vector<Imath::V3d> normals_;  ///< of the fronts; zero for a degenerate triangle
    std::vector<float> offsets_;
    std::unique_ptr<Embree> embree_;
};

}  // namespace vmap::reference
