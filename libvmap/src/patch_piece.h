// SPDX-License-Identifier: Apache-2.0
/// \file
/// Patches in the making: what the steps that find, cut and join them hand to each other.
#pragma once

#include <vmap/patch.h>
#include <vmap/point_cloud.h>
#include <vmap/polygon_set.h>

#include <Imath/ImathVec.h>

#include <cstdint>
#include <span>
#include <vector>

namespace vmap {

/// A patch before its points have their place in the common order.
struct Piece {
    Patch patch;
    std::vector<std::uint32_t> points;
    std::vector<Imath::V2d> outline;  ///< in the patch's frame
};

/// A line in the plane of a patch: points q with direction-normal inward.dot(q) = offset.
struct Edge {
    Imath::V2d inward;
    double offset;
};

[[nodiscard]] double area_of(const PointCloud& cloud, std::span<const std::uint32_t> points);

[[nodiscard]] Imath::V3d any_perpendicular(const Imath::V3d& n);

/// Frame of a plane with u along the given direction.
[[nodiscard]] Patch make_patch(const Imath::V3d& center, const Imath::V3d& normal, const Imath::V3d& u, double area,
                               bool flat);

/// Plane coordinates of points.
[[nodiscard]] std::vector<Imath::V2d> project(const PointCloud& cloud, std::span<const std::uint32_t> points,
                                              const Patch& patch);

/// The edges of a counter-clockwise outline, in its order.
[[nodiscard]] std::vector<Edge> edges_of(const std::vector<Imath::V2d>& outline);

/// Vertices where consecutive edges meet; empty when two of them do not.
[[nodiscard]] std::vector<Imath::V2d> outline_of(const std::vector<Edge>& edges);

/// The outlines in the world, relative to the cloud's origin.
[[nodiscard]] PolygonSet outlines_of(std::span<const Piece> pieces);

}  // namespace vmap
