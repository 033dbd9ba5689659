// SPDX-License-Identifier: Apache-2.0
/// \file
/// Light that a flat polygon of constant radiance sends to a surface element, in closed form, and what is left of it
/// when other polygons stand between: exact soft shadows without a ray.
///
/// This work is based on:
///   J. H. Lambert, Photometria, 1760 (the contour sum);
///   T. Nishita, E. Nakamae, "Half-tone representation of 3-D objects illuminated by area sources or polyhedron
///   sources", COMPSAC 1983 (clipping the source by the pyramids of the obstacles).
#pragma once

#include <Imath/ImathVec.h>

#include <optional>
#include <span>
#include <vector>

namespace vmap {

/// Irradiance on the element divided by the polygon's radiance; pi for a polygon that covers the whole hemisphere.
///
/// - position, normal: of the element; world units and unit length
/// - vertices: of a flat convex polygon, in order; the part below the element's horizon does not count
/// - returns 0 when the element lies behind the polygon, where its vertices turn clockwise
[[nodiscard]] double polygon_irradiance(const Imath::V3d& position, const Imath::V3d& normal,
                                        std::span<const Imath::V3d> vertices);

/// The same with convex polygons in the way.
///
/// - blockers: any polygons; what lies less than `clearance` above the element's horizon or behind the light is ignored
/// - no value when the light falls into more pieces than are worth counting
[[nodiscard]] std::optional<double> visible_polygon_irradiance(const Imath::V3d& position, const Imath::V3d& normal,
                                                               std::span<const Imath::V3d> light,
                                                               std::span<const std::vector<Imath::V3d>> blockers,
                                                               double clearance);

}  // namespace vmap
