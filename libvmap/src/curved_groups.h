// SPDX-License-Identifier: Apache-2.0
/// \file
/// Curved surface as small groups of points, bounded in number, extent and range of normals.
#pragma once

#include "patch_piece.h"

namespace vmap {

/// - points: indices into the cloud, reordered
/// - most_points: of a group
/// - normal_range: by at most about which the normals of a group differ, radians
/// - groups: receives the groups
void cut_into_groups(const PointCloud& cloud, std::span<std::uint32_t> points, std::size_t most_points,
                     float normal_range, std::vector<Piece>& groups);

}  // namespace vmap
