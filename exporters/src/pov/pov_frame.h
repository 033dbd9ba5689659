// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Where the world lies in a POV-Ray file.
#pragma once

#include <vmap/axes.h>
#include <vmap/scene.h>

#include <Imath/ImathBox.h>
#include <Imath/ImathMatrix.h>

namespace vmap {

/// Axes and scale of a file, and how large the scene is in it.
struct PovFrame {
    double scale = 1;              ///< units of the file in a world unit, a power of ten
    Imath::M44d frame_from_world;  ///< row vectors; rotation and scale
    Imath::V3d center{0, 0, 0};    ///< of the scene, file units
    double diameter = 1;           ///< of the scene, file units; positive

    /// POV-Ray drops intersections nearer than 1e-4, so that small scenes are scaled up; very large ones come down for
    /// the sake of its floats.
    PovFrame(const Imath::Box3d& world_bounds, UpAxis up);
};

/// The declaration of a camera in the frame. Its rows and columns follow the size that povray is told.
[[nodiscard]] std::string pov_camera(const Camera& camera, const PovFrame& frame);

}  // namespace vmap
