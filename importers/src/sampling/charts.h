// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Parts of a surface that can be looked at in one plane without much distortion.
#pragma once

#include "lit_surface.h"

#include <Imath/ImathVec.h>

#include <cstdint>
#include <vector>

namespace vmap {

/// Connected triangles whose normals are near one direction.
struct Chart {
    Imath::V3d normal{0, 0, 1};  ///< of its largest flat part
    double min_cosine = 1;       ///< between it and the normals of the triangles
};

struct Charts {
    std::vector<Chart> charts;
    std::vector<std::uint32_t> chart_of;  ///< of each triangle
    std::vector<std::uint32_t> flat_of;   ///< flat part of each triangle: connected and coplanar; inside one chart
    std::vector<double> flat_areas;       ///< of each flat part
};

/// Triangles are neighbours where they share an edge as sides of one sheet.
[[nodiscard]] Charts find_charts(const LitSurface& surface);

}  // namespace vmap
