// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Planes and quadrics through a few points.
#pragma once

#include <Imath/ImathVec.h>

#include <span>

namespace vmap {

/// A plane that fits points in the least squares sense.
struct FittedPlane {
    Imath::V3d center{0, 0, 0};  ///< mean of the points
    Imath::V3d normal{0, 0, 1};  ///< unit length, of either sign
    double deviation = 0;        ///< of the points from the plane, root mean square, corrected for the fit's freedom
};

/// - points: three or more
[[nodiscard]] FittedPlane fit_plane(std::span<const Imath::V3d> points);

/// A quadric height field over a plane that fits points in the least squares sense.
struct FittedQuadric {
    Imath::V3d normal{0, 0, 1};  ///< at the first of the points, unit length, on the side of the plane's normal
    double deviation = 0;        ///< of the points, root mean square, corrected for the fit's freedom
};

/// What a quadric leaves over is noise or a crease, not curvature. Fewer than eight points determine none: the plane's
/// normal and an infinite deviation.
[[nodiscard]] FittedQuadric fit_quadric(std::span<const Imath::V3d> points, const FittedPlane& plane);

}  // namespace vmap
