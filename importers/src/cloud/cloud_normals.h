// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Normals of points that have none.
///
/// This work is based on:
///   H. Hoppe et al., "Surface reconstruction from unorganized points", SIGGRAPH 1992 (the plane of the neighbours);
///   B. Li et al., "Robust normal estimation for point clouds with sharp features", Computers & Graphics 34, 2010 (at a
///   crease a point takes the plane of the neighbours that lie on one side of it).
#pragma once

#include "neighbours.h"

#include <Imath/ImathVec.h>

#include <cstddef>
#include <span>
#include <vector>

namespace vmap {

struct NormalEstimate {
    std::vector<Imath::V3f> normals;  ///< unit length, of either sign
    double noise = 0;                 ///< deviation of the points from the surface, root mean square, world units
    std::size_t neighbours = 0;       ///< that each plane was fitted to
    std::size_t creases = 0;          ///< points that took the plane of one side of a crease
};

/// Fits planes to the nearest neighbours: few where the points are exact, more where they are noisy. Where neither
/// plane nor quadric fits, the point lies at a crease and takes the plane of those neighbours that it lies in one plane
/// with.
///
/// - positions: no two the same
/// - neighbours: of the positions; as many a point as may be used
/// - spacing: of neighbouring points, world units
[[nodiscard]] NormalEstimate estimate_normals(std::span<const Imath::V3f> positions, const Neighbours& neighbours,
                                              double spacing, const Watch& watch = {});

}  // namespace vmap
