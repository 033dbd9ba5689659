// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The images of a paint, with everything multiplied in that POV-Ray cannot multiply.
#pragma once

#include "../png_image.h"
#include "paint.h"

#include <vmap/surface_shading.h>

#include <array>
#include <cstdint>
#include <vector>

namespace vmap {

/// Samples that own their memory.
struct PaintImage {
    int width = 0;
    int height = 0;
    int channels = 3;
    int bits_per_sample = 8;
    std::vector<std::uint8_t> bytes;

    [[nodiscard]] PngImage view() const {
        return {.width = width,
                .height = height,
                .channels = channels,
                .bits_per_sample = bits_per_sample,
                .bytes = bytes,
                .texts = {}};
    }
};

enum class PaintLayer { albedo, emission };

/// The image of a paint of kind image: albedo, or emission without its factor; alpha is 0 or 1 by the mask.
/// 8-bit samples where they lose nothing against the source, else 16.
[[nodiscard]] PaintImage image_of_paint(const Scene& scene, const Paint& paint, PaintLayer layer);

/// Square tiles, row by row: the triangle's first vertex lies at a tile's first texel, the second at the end of its
/// first row, the third at the end of its first column.
struct TileLayout {
    int tile_size = 2;
    int columns = 1;
    int rows = 1;

    [[nodiscard]] int width() const { return columns * tile_size; }
    [[nodiscard]] int height() const { return rows * tile_size; }

    /// Coordinates of a triangle's vertices in the image, in [0, 1], v downwards.
    [[nodiscard]] std::array<Imath::V2d, 3> corners(std::size_t triangle) const;
};

/// Tiles as fine as the images of the material, as far as their number allows.
[[nodiscard]] TileLayout layout_tiles(const Scene& scene, const Mesh& mesh);

/// The image of a paint of kind tiles.
/// - instance: any one that places the mesh
[[nodiscard]] PaintImage tiles_of_paint(const SurfaceShading& shading, std::size_t instance, const TileLayout& layout,
                                        PaintLayer layer);

}  // namespace vmap
