// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Evenly spread points on a surface.
#pragma once

#include "lit_surface.h"
#include "placement.h"

#include <vmap/progress.h>
#include <vmap/surface_shading.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace vmap {

/// Large connected parts get points of a blue-noise tile; parts that are too small for one are pieced together and get
/// one point for each equal piece.
///
/// - counts: points for each surface, indexed by LitTriangle::surface
/// - spacing: mean distance of neighbouring points, world units
[[nodiscard]] Placement place_blue_noise(const LitSurface& surface, const SurfaceShading& shading,
                                         std::span<const std::size_t> counts, double spacing, std::uint64_t seed,
                                         const ProgressCallback& progress);

}  // namespace vmap
