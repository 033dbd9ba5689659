// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// From places on triangles to points with all that belongs to them.
#pragma once

#include "lit_surface.h"
#include "placement.h"

#include <vmap/importers/sample_surface.h>
#include <vmap/point_cloud.h>
#include <vmap/progress.h>
#include <vmap/surface_shading.h>

#include <string>
#include <vector>

namespace vmap {

/// - placement: consumed
/// - spacing: mean distance of neighbouring points, world units: textures are averaged over a square of it
/// - warnings: gets a line when albedo had to be clamped
[[nodiscard]] PointCloud finish_points(const LitSurface& surface, const SurfaceShading& shading, Placement placement,
                                       double spacing, SampleNormals normals, const ProgressCallback& progress,
                                       std::vector<std::string>& warnings);

}  // namespace vmap
