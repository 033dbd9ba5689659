// SPDX-License-Identifier: Apache-2.0
/// \file
/// The one place where axes are converted. Inside the toolkit the world is glTF's: right-handed, Y up. Files that are Z
/// up hold Blender's view of the same world: glTF's (x, y, z) is (x, -z, y) there.
#pragma once

#include <Imath/ImathVec.h>

namespace vmap {

enum class UpAxis { y, z };

/// A world vector as a file with this up axis writes it.
template <class T>
[[nodiscard]] Imath::Vec3<T> file_from_world(UpAxis up, const Imath::Vec3<T>& v) {
    return up == UpAxis::y ? v : Imath::Vec3<T>(v.x, -v.z, v.y);
}

/// A vector of a file with this up axis in the world; the inverse of file_from_world.
template <class T>
[[nodiscard]] Imath::Vec3<T> world_from_file(UpAxis up, const Imath::Vec3<T>& v) {
    return up == UpAxis::y ? v : Imath::Vec3<T>(v.x, v.z, -v.y);
}

}  // namespace vmap
