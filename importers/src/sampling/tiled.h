// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Blue noise on charts: a ranked tile of points is laid over each chart's plane and lifted to its triangles. Where the
/// surface is steeper the plane has to hold more points, so higher ranks count there.
#pragma once

#include "blue_noise_tile.h"
#include "charts.h"
#include "lit_surface.h"
#include "placement.h"

#include <vmap/progress.h>
#include <vmap/surface_shading.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vmap {

/// Triangles of one chart and one surface that get a number of points of their own.
struct Pool {
    std::uint32_t chart = 0;
    std::size_t first = 0;  ///< of its triangles
    std::size_t last = 0;
    double area = 0;         ///< world units squared
    std::size_t points = 0;  ///< that it gets
};

/// Lays points over pools, exactly as many as each asks for.
///
/// - triangles: indices into the surface's, pool after pool
/// - spacing: mean distance of neighbouring points, world units
/// - points: where they go, pool after pool; as many as the pools ask for
/// - returns for each pool true when the tile does not find enough places in it; its points are left as they are
[[nodiscard]] std::vector<bool> place_tiled(const LitSurface& surface, const Charts& charts,
                                            std::span<const std::uint32_t> triangles, std::span<const Pool> pools,
                                            const BlueNoiseTile& tile, const SurfaceShading& shading, double spacing,
                                            std::uint64_t seed, const ProgressCallback& progress,
                                            std::span<PlacedPoint> points);

}  // namespace vmap
