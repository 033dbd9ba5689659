// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Parts of a surface that can be looked at in one plane without much distortion.
#pragma once

#include "lit_surface.h"

#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>
#include <vector>

namespace vmap {

/// For each triangle the one over the edge from its first corner to its second, second to third, third to first.
using Neighbours = std::vector<std::array<std::uint32_t, 3>>;
inline constexpr std::uint32_t no_neighbour = 0xFFFFFFFF;

/// Connected triangles whose normals are near one direction.
struct Chart {
    Imath::V3d normal{0, 0, 1};  ///< of its largest flat part
    double min_cosine = 1;       ///< between it and the normals of the triangles
};

struct Charts {
    Neighbours neighbours;  ///< over smooth edges, on the same sheet
    std::vector<Chart> charts;
    std::vector<std::uint32_t> chart_of;  ///< of each triangle
    std::vector<std::uint32_t> flat_of;   ///< flat part of each triangle: connected and coplanar; inside one chart
    std::vector<double> flat_areas;       ///< of each flat part
};

/// - spacing: mean distance of the points to come, world units: bumps of triangles smaller than that do not matter
[[nodiscard]] Charts find_charts(const LitSurface& surface, double spacing);

}  // namespace vmap
