// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Which sides of a scene's faces can be lit.
#pragma once

#include <vmap/importers/sample_surface.h>
#include <vmap/scene.h>

#include <Imath/ImathVec.h>

#include <cstdint>
#include <vector>

namespace vmap {

inline constexpr std::uint8_t front_side = 1;
inline constexpr std::uint8_t back_side = 2;

/// For every face, numbered over all instances: front_side, back_side or both.
///
/// SampleSides::automatic lights the front of every face and the back of double-sided ones, but of the double-sided
/// faces of a closed part only the side that looks outwards, unless a point light, spot, camera or another emitting
/// part is inside. A part is what hangs together over edges of two faces; it is closed when an even number of faces
/// meets at each of its edges, none of them is cut by an alpha mask, and it has an inside and an outside.
///
/// - origin: of the coordinates that are compared, near the scene, world units
[[nodiscard]] std::vector<std::uint8_t> find_lit_sides(const Scene& scene, SampleSides sides, const Imath::V3d& origin);

}  // namespace vmap
