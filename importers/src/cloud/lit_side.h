// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Whether a scan is of a room from the inside or of an object from the outside.
#pragma once

#include <vmap/light_source.h>

#include <Imath/ImathVec.h>

#include <span>

namespace vmap {

/// Whether a light has the surface around it: then only the inside can be lit.
///
/// - positions, normals, areas: of the points; normals face outward
/// - lights: in the frame of the positions
[[nodiscard]] bool encloses_light(std::span<const Imath::V3f> positions, std::span<const Imath::V3f> normals,
                                  std::span<const float> areas, std::span<const LightSource> lights);

/// Whether the points look like a furnished room: four or more sides of an upright box around them are covered by
/// points, and there are others in the middle. What has nothing inside may as well be a crate.
///
/// - positions: in the world, so that y is up; not empty
[[nodiscard]] bool looks_like_a_room(std::span<const Imath::V3f> positions);

}  // namespace vmap
