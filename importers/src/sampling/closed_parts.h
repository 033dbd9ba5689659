// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Closed parts of a scene: where the inside of a double-sided surface is never seen.
///
/// This work is based on:
///   A. Van Oosterom, J. Strackee, "The solid angle of a plane triangle", 1983 (whether a place is inside).
#pragma once

#include <vmap/scene.h>

#include <Imath/ImathVec.h>

#include <cstdint>
#include <vector>

namespace vmap {

/// Takes the side that looks inwards from faces of closed parts that have both, unless something that sees or lights
/// is inside; see find_lit_sides.
/// - origin: of the coordinates that are compared, near the scene, world units
/// - lit: sides of every face, numbered over all instances; changed
void leave_out_insides(const Scene& scene, const Imath::V3d& origin, std::vector<std::uint8_t>& lit);

}  // namespace vmap
