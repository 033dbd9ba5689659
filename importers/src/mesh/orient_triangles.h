// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// One direction of winding for each connected piece of surface.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vmap {

using IndexTriangle = std::array<std::uint32_t, 3>;

struct Orientation {
    std::vector<bool> flip;        ///< of each triangle: to be turned around
    std::size_t flipped = 0;       ///< how many are
    std::size_t unorientable = 0;  ///< edges whose triangles still disagree, as on a Moebius strip
};

/// Turns triangles so that two that share an edge run along it in opposite directions. Edges of three and more
/// triangles connect nothing. In each connected piece the smaller number of triangles is turned, so that the file's own
/// choice of the front stays.
///
/// - triangles: vertices of the same position have the same index
[[nodiscard]] Orientation orient_triangles(std::span<const IndexTriangle> triangles);

}  // namespace vmap
