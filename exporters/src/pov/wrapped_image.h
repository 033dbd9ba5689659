// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// POV-Ray repeats images and knows no other wrapping: images are extended so that repeating them gives the same.
#pragma once

#include <vmap/scene.h>

#include <Imath/ImathVec.h>

#include <algorithm>

namespace vmap {

/// Texels of an extended image along one axis: mirrored images stand beside their mirror image, clamped ones have one
/// more texel at both ends.
[[nodiscard]] inline int extended_size(WrapMode wrap, int size) {
    if (wrap == WrapMode::mirrored_repeat) return 2 * size;
    return wrap == WrapMode::clamp_to_edge ? size + 2 : size;
}

/// The texture coordinate, in [0, 1], of a place in the extended image, in its texels from its edge.
[[nodiscard]] inline double source_coordinate(WrapMode wrap, double place, int size) {
    if (wrap == WrapMode::mirrored_repeat) return std::min(place, 2 * size - place) / size;
    return (wrap == WrapMode::clamp_to_edge ? std::clamp(place - 1, 0.0, 1.0 * size) : place) / size;
}

/// The texture coordinate in the extended image, both in [0, 1] across their image.
[[nodiscard]] inline double extended_coordinate(WrapMode wrap, double coordinate, int size) {
    if (wrap == WrapMode::mirrored_repeat) return coordinate / 2;
    return wrap == WrapMode::clamp_to_edge ? (coordinate * size + 1) / (size + 2) : coordinate;
}

/// Whether repeating the extended image is right at a coordinate: clamped ones reach half a texel beyond their edges.
[[nodiscard]] inline bool extended_image_reaches(WrapMode wrap, double coordinate, int size) {
    return wrap != WrapMode::clamp_to_edge || (coordinate * size >= -0.5 && coordinate * size <= size + 0.5);
}

/// Place in the image of a texture coordinate.
[[nodiscard]] inline Imath::V2d image_coordinate(const TextureView& view, const Imath::V2f& texcoord) {
    const auto& m = view.image_from_texcoord;
    return {m[0][0] * texcoord.x + m[0][1] * texcoord.y + m[0][2],
            m[1][0] * texcoord.x + m[1][1] * texcoord.y + m[1][2]};
}

}  // namespace vmap
