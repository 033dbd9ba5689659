// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Surface that each point of a cloud stands for.
#pragma once

#include "neighbours.h"

#include <Imath/ImathVec.h>

#include <span>
#include <vector>

namespace vmap {

/// Areas of the Voronoi cells in the tangent planes. Neighbours around a crease count where unfolding the crease would
/// put them. Where a wide angle holds no neighbour the surface ends: the cell reaches a quarter of the spacing that
/// way.
///
/// - normals: unit length; sides agree between neighbours
/// - returns areas, positive, world units squared
[[nodiscard]] std::vector<float> estimate_areas(std::span<const Imath::V3f> positions,
                                                std::span<const Imath::V3f> normals, const Neighbours& neighbours,
                                                const Watch& watch = {});

}  // namespace vmap
