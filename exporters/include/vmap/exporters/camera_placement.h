// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A camera for what has none.
#pragma once

#include <vmap/point_cloud.h>
#include <vmap/scene.h>

#include <Imath/ImathBox.h>

namespace vmap {

/// A perspective camera in front of, right of and above the bounds (+Y is up), looking at their centre from as near as
/// still shows every corner of them in a picture of this aspect.
///
/// - bounds: world units, finite; of a single place the camera stands one unit away; empty ones count as the origin
/// - aspect: width / height of the picture, positive
[[nodiscard]] Camera place_camera(const Imath::Box3d& bounds, double aspect = 1);

/// Bounds of everything that is placed in a scene, world units; empty when nothing is.
[[nodiscard]] Imath::Box3d bounds_of(const Scene& scene);

/// Bounds of the points, world units; empty when there are none.
[[nodiscard]] Imath::Box3d bounds_of(const PointCloud& cloud);

}  // namespace vmap
