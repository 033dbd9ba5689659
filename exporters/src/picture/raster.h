// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Which polygon is seen at 16 places of every pixel. Polygons are cut at the camera's plane, projected, sorted into
/// tiles of the picture and drawn row by row; of two in one place the nearer stays.
#pragma once

#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "shapes.h"
#include "view.h"

namespace vmap::picture {

/// The places of a pixel: eight rows of two, shifted so that no two share a row or a column.
inline constexpr int rows_per_pixel = 8;
inline constexpr int columns_per_pixel = 2;
inline constexpr int places_per_pixel = rows_per_pixel * columns_per_pixel;

inline constexpr int tile_side = 32;  ///< pixels
inline constexpr std::uint32_t nothing = 0xFFFFFFFFU;

/// Picture coordinates of a place of pixel (0, 0).
[[nodiscard]] Imath::V2d place_in_pixel(int place);

/// The polygon that is seen at each place of a tile, or nothing.
struct TileContent {
    static constexpr int rows = tile_side * rows_per_pixel;
    static constexpr int columns = tile_side * columns_per_pixel;

    std::array<std::uint32_t, static_cast<std::size_t>(rows) * columns> polygon;
    std::array<float, static_cast<std::size_t>(rows) * columns> nearness;

    [[nodiscard]] static std::size_t index(int row, int column) {
        return static_cast<std::size_t>(row) * columns + static_cast<std::size_t>(column);
    }
    /// Pixel and place count from the tile's corner.
    [[nodiscard]] std::uint32_t at(int x, int y, int place) const {
        return polygon[index(y * rows_per_pixel + place / columns_per_pixel,
                             x * columns_per_pixel + place % columns_per_pixel)];
    }
};

class Raster {
public:
    /// Says whether a polygon has a hole at a picture place.
    using CutTest = std::function<bool(std::uint32_t polygon, double x, double y)>;

    /// Keeps references to all arguments.
    /// - nearest: depth below which nothing is drawn, world units, positive
    Raster(const Shapes& shapes, const View& view, double nearest);

    [[nodiscard]] int tiles_across() const { return tiles_across_; }
    [[nodiscard]] int tiles_down() const { return tiles_down_; }

    void draw(int tile_x, int tile_y, const CutTest& is_cut, TileContent& content) const;

    /// Nearness of the plane of a polygon that draw() has reported.
    [[nodiscard]] Nearness plane(std::uint32_t polygon) const;

private:
    struct Outline {
        std::uint32_t polygon = 0;
        std::uint32_t first_vertex = 0;
        std::uint32_t vertex_count = 0;
        Nearness nearness;
        std::array<int, 4> pixels{};  ///< first and last column, first and last row
    };
    struct Projection {
        std::vector<Outline> outlines;
        std::vector<Imath::V2d> vertices;
    };

    void project(std::uint32_t polygon, double nearest, Projection& to) const;
    void sort_into_tiles();
    void draw(const Outline& outline, int first_x, int first_y, const CutTest& is_cut, TileContent& content) const;

    const Shapes& shapes_;
    const View& view_;
    int tiles_across_;
    int tiles_down_;
    double coincidence_;  ///< in orthographic views: depth by which coincident sheets are told apart
    std::vector<Outline> outlines_;
    std::vector<Imath::V2d> vertices_;
    std::vector<std::uint32_t> tile_first_;     ///< where each tile's list begins
    std::vector<std::uint32_t> tile_outlines_;  ///< indices into outlines_, tile after tile, in order
};

}  // namespace vmap::picture
