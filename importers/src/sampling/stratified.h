// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// One point at random in each of equal pieces of surface.
///
/// The triangles are laid end to end on a line by their area, and each triangle's stretch is folded into it by halving
/// the longest edge again and again. Equal stretches of the line are the pieces: compact, whatever the triangles are.
///
/// This work is based on:
///   M. C. Rivara, "Algorithms for refining triangular grids suitable for adaptive and simultaneous techniques", 1984
///   (longest-edge bisection).
#pragma once

#include "lit_surface.h"
#include "placement.h"

#include <vmap/surface_shading.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace vmap {

/// - triangles: indices into the surface's, neighbours near each other in the order
/// - points: where the points go; as many pieces as there are elements
void place_stratified(const LitSurface& surface, std::span<const std::uint32_t> triangles, std::uint64_t seed,
                      std::span<PlacedPoint> points);

/// The same for whole surfaces: as many points for each as counts says, indexed by LitTriangle::surface.
[[nodiscard]] Placement place_stratified(const LitSurface& surface, const SurfaceShading& shading,
                                         std::span<const std::size_t> counts, std::uint64_t seed);

/// Points that an alpha mask cuts away are put elsewhere on their triangle.
void move_off_cuts(const LitSurface& surface, const SurfaceShading& shading, std::uint64_t seed,
                   std::span<PlacedPoint> points);

/// Where a triangle is on a curve through space.
[[nodiscard]] std::uint64_t place_on_curve(const LitSurface& surface, std::uint32_t triangle);

/// Sorts triangles along that curve, so that neighbours in the order are near each other.
void sort_by_place(const LitSurface& surface, std::span<std::uint32_t> triangles);

}  // namespace vmap
