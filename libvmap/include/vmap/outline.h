// SPDX-License-Identifier: Apache-2.0
/// \file
/// The outline of a flat piece of surface that is known by its points only. The points' areas sum to the surface, so an
/// outline of the right shape is put where it encloses just that area: exact for a wall, whatever the sampling.
///
/// This work is based on:
///   A. M. Andrew, "Another efficient algorithm for convex hulls in two dimensions", 1979 (monotone chain);
///   H. Freeman, R. Shapira, "Determining the minimum-area encasing rectangle for an arbitrary closed curve", 1975.
#pragma once

#include <Imath/ImathVec.h>

#include <optional>
#include <span>
#include <vector>

namespace vmap {

/// Convex hull, counter-clockwise, without collinear vertices; fewer than three vertices when the points have no area.
[[nodiscard]] std::vector<Imath::V2d> convex_hull(std::vector<Imath::V2d> points);

/// Area of a polygon, positive when it is counter-clockwise.
[[nodiscard]] double polygon_area(std::span<const Imath::V2d> polygon);

/// A convex polygon with every edge moved outwards by `distance` (inwards when negative) in its own plane.
[[nodiscard]] std::vector<Imath::V2d> offset_polygon(std::span<const Imath::V2d> polygon, double distance);

/// The simplest convex outline (a rectangle before others, at most max_polygon_vertices) of points that stand for
/// `area` and lie `spacing` apart: it encloses that area, and its border runs between 0.15 spacings inside and 0.95
/// spacings outside of the hull of the points. No value when no convex outline does so: the piece has a notch or a
/// hole.
[[nodiscard]] std::optional<std::vector<Imath::V2d>> fit_outline(std::span<const Imath::V2d> points, double area,
                                                                 double spacing);

/// The hull of the points scaled to the area, whatever its shape: the last resort for a handful of points.
[[nodiscard]] std::vector<Imath::V2d> rough_outline(std::span<const Imath::V2d> points, double area, double spacing);

/// The straight cut (coordinate `axis` at `position`) that best separates a piece that is not convex, found where the
/// row or column profile of its points jumps. The points' frame should follow the sides of the piece.
struct OutlineCut {
    int axis = 0;
    double position = 0;
};
[[nodiscard]] OutlineCut best_cut(std::span<const Imath::V2d> points, double spacing);

}  // namespace vmap
