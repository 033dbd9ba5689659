// SPDX-License-Identifier: Apache-2.0
/// \file
/// How flat pieces meet: cut where a wall stands on them from border to border, so that no piece has two sides of a
/// wall in it, and joined along the lines where their planes cut, so that rays find no crack.
#pragma once

#include "patch_piece.h"

#include <vector>

namespace vmap {

/// Cuts every flat piece along the walls that stand on its lit side from border to border.
void cut_at_walls(const PointCloud& cloud, std::vector<Piece>& pieces);

/// Moves the edges of flat pieces onto the lines where the planes of adjoining ones cut theirs.
void snap_edges(std::vector<Piece>& pieces);

}  // namespace vmap
