// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The sides that estimated normals face.
#pragma once

#include "neighbours.h"

#include <vmap/importers/prepare_cloud.h>

#include <Imath/ImathVec.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vmap {

/// Points whose normals agree on their sides, all connected pieces of a cloud.
struct CloudPieces {
    std::vector<std::uint32_t> piece_of;  ///< of each point
    std::size_t count = 0;
};

/// Makes neighbouring normals agree: along a minimum spanning tree over smooth surface, by a vote of all neighbours
/// across creases. The side that a piece as a whole faces remains open.
[[nodiscard]] CloudPieces make_normals_agree(std::span<const Imath::V3f> positions, const Neighbours& neighbours,
                                             std::span<Imath::V3f> normals);

/// Turns whole pieces to a side.
/// - side: not automatic
void turn_pieces(std::span<const Imath::V3f> positions, const CloudPieces& pieces, CloudSide side,
                 std::span<Imath::V3f> normals);

/// Turns every normal towards a point.
void turn_to_viewpoint(std::span<const Imath::V3f> positions, const Imath::V3d& viewpoint,
                       std::span<Imath::V3f> normals);

}  // namespace vmap
