// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What an affine matrix of row vectors does to directions and volumes.
#pragma once

#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

namespace vmap::gltf {

/// The image of an axis: 0, 1, 2 for x, y, z.
[[nodiscard]] inline Imath::V3d axis(const Imath::M44d& m, int i) {
    return {m[i][0], m[i][1], m[i][2]};
}

/// Change of volume; negative for a mirror, 0 when everything becomes flat.
[[nodiscard]] inline double volume_factor(const Imath::M44d& m) {
    return axis(m, 0).dot(axis(m, 1).cross(axis(m, 2)));
}

/// A surface normal after the surface was moved, on the same side of it; not of unit length.
[[nodiscard]] inline Imath::V3d transformed_normal(const Imath::M44d& m, const Imath::V3f& normal) {
    // Cofactors: the inverse transpose up to a factor, also where there is no inverse.
    const Imath::V3d cofactor = axis(m, 1).cross(axis(m, 2)) * normal.x + axis(m, 2).cross(axis(m, 0)) * normal.y +
                                axis(m, 0).cross(axis(m, 1)) * normal.z;
    return volume_factor(m) < 0 ? -cofactor : cofactor;
}

}  // namespace vmap::gltf
