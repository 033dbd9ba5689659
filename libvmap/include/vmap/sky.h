// SPDX-License-Identifier: Apache-2.0
/// \file
/// Light from beyond the scene, by direction.
#pragma once

#include <Imath/ImathColor.h>
#include <Imath/ImathVec.h>

#include <cstddef>
#include <span>
#include <vector>

namespace vmap {

/// A panorama in equal steps of longitude and latitude: its centre lies along +X, its right half along +Z, its top
/// along +Y, as Blender's world textures lie once their scene is Y up. Without values the sky is black.
struct Sky {
    int width = 0;
    int height = 0;
    std::vector<Imath::C3f> radiance;  ///< width * height, rows from the top, W/(m^2 sr), linear Rec.709

    [[nodiscard]] bool empty() const { return radiance.empty(); }

    /// Index into radiance of what lies in a direction of any length but 0.
    [[nodiscard]] std::size_t at(const Imath::V3f& direction) const;
};

/// The same radiance from all around.
[[nodiscard]] Sky even_sky(const Imath::C3f& radiance);

/// Means over the pixels of a panorama, at most `most_width` wide: fine enough for diffuse light. Negative values count
/// as 0.
///
/// - pixels: width * height, rows from the top, finite
[[nodiscard]] Sky sky_of_panorama(std::span<const Imath::C3f> pixels, int width, int height, int most_width = 256);

}  // namespace vmap
