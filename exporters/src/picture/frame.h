// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Directions in a plane.
#pragma once

#include <Imath/ImathVec.h>

#include <cmath>

namespace vmap::picture {

/// Some unit vector at right angles to a unit vector; the same one for the same vector.
[[nodiscard]] inline Imath::V3f any_perpendicular(const Imath::V3f& n) {
    return n.cross(std::abs(n.x) < 0.6F ? Imath::V3f(1, 0, 0) : Imath::V3f(0, 1, 0)).normalized();
}

}  // namespace vmap::picture
