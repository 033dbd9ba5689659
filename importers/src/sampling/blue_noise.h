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

/// Connected parts that a plane shows well get points of a blue-noise tile, in numbers by their areas; where such parts
/// meet smoothly their points are evened out.
///
/// - counts: points for each surface, indexed by LitTriangle::surface
/// - spacing: mean distance of neighbouring points, world units
[[nodiscard]] Placement place_blue_noise(const LitSurface& surface, const SurfaceShading& shading,
                                         std::span<const std::size_t> counts, double spacing, std::uint64_t seed,
                                         const ProgressCallback& progress);

}  // namespace vmap
