// SPDX-License-Identifier: Apache-2.0
/// \file
/// The one place where images are looked up: wrapping, decoding, and averaging over the part of a surface that a sample
/// stands for. Colours are decoded to linear light before they are averaged.
///
/// This work is based on:
///   L. Williams, "Pyramidal parametrics", SIGGRAPH 1983 (the pyramid);
///   J. McCormack et al., "Feline: fast elliptical lines for anisotropic texture mapping", SIGGRAPH 1999 (several looks
///   along the long axis of a footprint).
#pragma once

#include <vmap/scene.h>
#include <vmap/srgb.h>

#include <Imath/ImathColor.h>
#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>
#include <vector>

namespace vmap {

/// What the bytes of an image mean.
enum class TexelMeaning {
    color,   ///< sRGB colour; alpha is carried along
    cutout,  ///< sRGB colour that counts in an average only as far as alpha lets it be seen
    data     ///< linear numbers
};

/// The part of a texture that one sample stands for: a parallelogram about a place, in texture coordinates before the
/// view's transform. Both axes zero: the place itself.
struct TextureFootprint {
    Imath::V2d center{0, 0};
    Imath::V2d axis_u{0, 0};  ///< one full width of the footprint
    Imath::V2d axis_v{0, 0};  ///< the other
};

/// An image and its averages over ever larger squares. Keeps a reference to the image, which must outlive it.
class TexturePyramid {
public:
    /// - image: at least one pixel
    TexturePyramid(const Image& image, TexelMeaning meaning);

    /// Average of the image over a footprint; red, green, blue decoded as the meaning says, alpha in [0, 1].
    [[nodiscard]] Imath::C4f average(const TextureView& view, const TextureFootprint& footprint) const;

    /// The value at one texture coordinate, unfiltered but interpolated unless the view says nearest.
    [[nodiscard]] Imath::C4f at(const TextureView& view, const Imath::V2d& texcoord) const;

private:
    /// Square roots of linear values in 16 bits: half the memory of floats, no visible step in the dark.
    using CodedTexel = std::array<std::uint16_t, 4>;
    struct Level {
        int width = 0;
        int height = 0;
        std::vector<CodedTexel> texels;
    };

    [[nodiscard]] int level_count() const { return static_cast<int>(levels_.size()) + 1; }
    [[nodiscard]] Imath::C4f texel(int level, int x, int y) const;
    [[nodiscard]] Imath::C4f interpolate(const TextureView& view, int level, const Imath::V2d& place) const;
    [[nodiscard]] Imath::C4f interpolate(const TextureView& view, double level, const Imath::V2d& place) const;
    [[nodiscard]] Imath::C4f finish(const Imath::C4f& value) const;
    [[nodiscard]] Level shrink(int level) const;
    [[nodiscard]] Imath::V2i size_of(int level) const;

    const Image* image_;
    TexelMeaning meaning_;
    std::vector<Level> levels_;  ///< half, quarter, ... of the image; the image itself is level 0
};

}  // namespace vmap
