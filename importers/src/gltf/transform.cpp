// SPDX-License-Identifier: GPL-3.0-or-later
#include "transform.h"

#include <Imath/ImathQuat.h>

namespace vmap::gltf {

Imath::M44d matrix_of(const Transform& transform) {
    const auto& [x, y, z, w] = transform.rotation;
    Imath::M44d matrix = Imath::Quatd(w, x, y, z).toMatrix44();
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) matrix[row][column] *= transform.scale[row];
    for (int column = 0; column < 3; ++column) matrix[3][column] = transform.translation[column];
    return matrix;
}

}  // namespace vmap::gltf
