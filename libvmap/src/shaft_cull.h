// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which occluders can block a segment between two boxes, judged in the plane of each occluder: the segments that cross
/// the plane do so in a rectangle, the footprint of the shaft.
#pragma once

#include "node_bounds.h"
#include "occluders.h"

#include <cstdint>
#include <span>
#include <vector>

namespace vmap {

/// Appends to `left` those of the occluders that may block some of the segments.
///
/// - returns true when one of them blocks every segment; what was appended then means nothing
[[nodiscard]] bool cull_occluders(const Occluders& occluders, std::span<const std::uint32_t> list, const TurnedBox& a,
                                  const TurnedBox& b, std::vector<std::uint32_t>& left);

}  // namespace vmap
