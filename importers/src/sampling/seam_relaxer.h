// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Evens out points where parts that were sampled on their own meet smoothly: there they come too near each other or
/// leave gaps. Points near the seams push each other away along the surface.
///
/// This work is based on:
///   G. Turk, "Generating textures on arbitrary surfaces using reaction-diffusion", SIGGRAPH 1991 (relaxation of points
///   on a surface).
#pragma once

#include "charts.h"
#include "lit_surface.h"
#include "placement.h"

#include <vmap/progress.h>
#include <vmap/surface_shading.h>

#include <cstdint>
#include <span>
#include <vector>

namespace vmap {

/// Nearest distance of neighbours in a flat part that relaxation must keep, over the mean spacing.
inline constexpr double kept_distance = 0.62;

/// What relaxation has to know of the parts.
struct SeamParts {
    std::vector<std::uint32_t> pool_of;  ///< of each triangle: no point leaves its pool
    std::vector<bool> is_loose;          ///< of each pool: its points do not come from its chart's tile
};

/// Moves points near seams. Points of one flat part that had kept_distance keep it.
/// - spacing: mean distance of neighbouring points, world units
void relax_seams(const LitSurface& surface, const SurfaceShading& shading, const Charts& charts, const SeamParts& parts,
                 double spacing, const ProgressCallback& progress, std::span<PlacedPoint> points);

}  // namespace vmap
