// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Polygons cut into triangles.
///
/// This work is based on:
///   G. H. Meisters, "Polygons have ears", American Mathematical Monthly 82, 1975 (an ear can always be cut off);
///   I. E. Sutherland, R. F. Sproull, R. A. Schumacker, "A characterization of ten hidden-surface algorithms", 1974
///   (Newell's normal of a polygon that is not quite flat).
#pragma once

#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace vmap {

/// Appends the triangles of one polygon, as numbers of its corners, wound as the polygon is. A simple polygon, concave
/// or not, is covered exactly; n corners give n - 2 triangles, some of them perhaps without area.
///
/// - corners: three or more, about flat
/// - returns false when the polygon crosses itself, so that some triangle had to be cut off where it lies outside
bool triangulate_polygon(std::span<const Imath::V3d> corners, std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace vmap
