// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Parts of a surface that can be looked at in one plane without much distortion.
#pragma once

#include "lit_surface.h"
#include "triangle_neighbours.h"

#include <Imath/ImathVec.h>

#include <cstdint>
#include <vector>

namespace vmap {

/// Connected triangles whose normals are near one direction.
struct Chart {
    Imath::V3d normal{0, 0, 1};  ///< of its first flat part
    double min_cosine = 1;       ///< between it and the normals of the triangles; not below steepest_shown
};

/// A plane shows triangles at this share of their area or more; what is steeper counts as this steep.
inline constexpr double steepest_shown = 0.45;

/// Triangles that are steeper than this against their chart are too small to matter and get no points.
inline constexpr double folded_cosine = 0.1;

struct Charts {
    Neighbours neighbours;  ///< over smooth edges, on the same sheet
    FlatParts flats;        ///< each lies in one chart
    std::vector<Chart> charts;
    std::vector<std::uint32_t> chart_of;  ///< of each triangle
};

/// - spacing: mean distance of the points to come, world units
[[nodiscard]] Charts find_charts(const LitSurface& surface, double spacing);

}  // namespace vmap
