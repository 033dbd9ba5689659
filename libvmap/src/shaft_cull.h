// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which walls can block a segment between two boxes. The segments that cross a wall's plane do so in a rectangle, the
/// footprint of the shaft.
#pragma once

#include "node_bounds.h"
#include "occluders.h"

#include <cstdint>
#include <span>
#include <vector>

namespace vmap {

/// Appends to `left` those of the walls that may block some of the segments.
///
/// - list: indices into the walls
/// - returns true when one of them blocks every segment; what was appended then means nothing
[[nodiscard]] bool cull_walls(std::span<const WallOccluder> walls, std::span<const std::uint32_t> list,
                              const TurnedBox& a, const TurnedBox& b, std::vector<std::uint32_t>& left);

}  // namespace vmap
