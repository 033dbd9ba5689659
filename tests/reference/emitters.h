// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Choice of places on the emissive triangles of a scene, by their power.
#pragma once

#include <reference/ray_scene.h>

#include <Imath/ImathColor.h>
#include <Imath/ImathVec.h>

#include <cstdint>
#include <vector>

namespace vmap::reference {

/// A place on an emissive triangle.
struct EmitterSample {
    std::uint32_t face = 0;
    SurfacePlace place;
    Imath::V3d position{0, 0, 0};  ///< in the frame of RayScene
    double density = 0;            ///< of the choice, per area
};

/// The emissive triangles. Keeps a reference to the scene of rays, which must outlive it.
class Emitters {
public:
    explicit Emitters(const RayScene& scene);

    [[nodiscard]] bool empty() const { return faces_.empty(); }

    /// - sample: in [0, 1)^2
    [[nodiscard]] EmitterSample choose(const Imath::V2d& sample) const;

    /// Density per area with which choose() takes a place on this face; 0 where nothing is emitted.
    [[nodiscard]] double density(std::uint32_t face) const { return empty() ? 0 : density_of_face_[face]; }

private:
    const RayScene* scene_;
    std::vector<std::uint32_t> faces_;
    std::vector<double> cumulative_;  ///< share of the power up to and with each of faces_; the last is 1
    std::vector<float> density_of_face_;
};

}  // namespace vmap::reference
