// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Small steps of a point over a surface.
///
/// This work is based on:
///   K. Polthier, M. Schmies, "Straightest geodesics on polyhedral surfaces", 1998.
#pragma once

#include "charts.h"
#include "lit_surface.h"
#include "placement.h"

#include <Imath/ImathVec.h>

#include <cstdint>
#include <span>

namespace vmap {

struct WalkEnd {
    PlacedPoint point;
    Imath::V3d place;  ///< relative to the surface's origin
};

/// Moves a point along its triangle and straight on over edges into triangles of the same pool; from other edges it
/// bounces off.
///
/// - pools: of each triangle
/// - step: world units; its part along the surface counts
[[nodiscard]] WalkEnd walk(const LitSurface& surface, const Neighbours& neighbours,
                           std::span<const std::uint32_t> pools, const PlacedPoint& from, const Imath::V3d& step);

}  // namespace vmap
