// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Families of small point clouds made in code, over which trees and V-maps are tested.
#pragma once

#include <vmap/point_cloud.h>

#include <string>
#include <vector>

namespace vmap::test {

struct NamedCloud {
    std::string name;
    PointCloud cloud;
};

/// Rooms, spheres, walls, sheets and clutter of about this many points each.
std::vector<NamedCloud> ordinary_clouds(int points);

/// One and two points, all equal, on a line, on a plane, 1e-6 and 1e6 units, survey coordinates and the like.
std::vector<NamedCloud> degenerate_clouds();

/// Both of the above.
std::vector<NamedCloud> all_clouds(int points);

/// A closed box of edge 1 around (0.5, 0.5, 0.5), points on a grid, normals inwards.
PointCloud empty_room(int points);

/// The same with three boxes that stand in it, one of them turned.
PointCloud packed_room(int points);

/// Moves and scales: position -> position * scale + offset.
void transform(PointCloud& cloud, float scale, const Imath::V3f& offset);

}  // namespace vmap::test
