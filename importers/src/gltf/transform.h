// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Translation, rotation and scale as glTF stores them.
#pragma once

#include <Imath/ImathMatrix.h>

#include <array>

namespace vmap::gltf {

struct Transform {
    std::array<double, 3> translation{0, 0, 0};
    std::array<double, 4> rotation{0, 0, 0, 1};  ///< quaternion x, y, z, w
    std::array<double, 3> scale{1, 1, 1};
};

/// Scales, then rotates, then translates; for row vectors. A quaternion that is a little off unit length is used as it
/// is, as viewers do.
[[nodiscard]] Imath::M44d matrix_of(const Transform& transform);

}  // namespace vmap::gltf
