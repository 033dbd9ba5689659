// SPDX-License-Identifier: Apache-2.0
/// \file
/// The discs of all leaves as occluders of the fast builder. Where many discs lie in one plane they are one occluder, a
/// wall: a raster of the plane says at once whether a place is covered, and sums over the raster say it of a rectangle.
///
/// This work is based on: F. Crow, "Summed-area tables for texture mapping", SIGGRAPH 1984.
#pragma once

#include "disc_list.h"

#include <vmap/leaf_visibility.h>

#include <Imath/ImathVec.h>

#include <cstdint>
#include <span>
#include <vector>

namespace vmap {

/// A rectangle in the coordinates of a plane.
struct PlaneRectangle {
    float u_min = 0;
    float u_max = 0;
    float v_min = 0;
    float v_max = 0;
};

/// Which parts of a plane its discs cover.
class PlaneRaster {
public:
    enum class Cell : std::uint8_t {
        empty,    ///< no disc meets it
        covered,  ///< one disc holds all of it
        mixed     ///< ask the discs
    };

    PlaneRaster() = default;
    PlaneRaster(std::span<const LeafDisc> discs, const PlaneRectangle& bounds);

    /// What the discs cover of a rectangle, as far as whole cells tell.
    [[nodiscard]] Cell look_up(const PlaneRectangle& rectangle) const;

    /// Columns, rows, and the cell of (u, v): floor((u - u_min) * per_unit).
    [[nodiscard]] int columns() const { return columns_; }
    [[nodiscard]] int rows() const { return rows_; }
    [[nodiscard]] float u_min() const { return u_min_; }
    [[nodiscard]] float v_min() const { return v_min_; }
    [[nodiscard]] float per_unit() const { return per_unit_; }
    /// Row after row; three bytes more than cells, so that four can be read at any of them.
    [[nodiscard]] const std::uint8_t* cells() const { return cells_.data(); }

    /// The discs that meet a mixed cell.
    [[nodiscard]] std::span<const LeafDisc> discs_at(std::size_t cell) const {
        return std::span(cell_discs_).subspan(first_disc_[cell], first_disc_[cell + 1] - first_disc_[cell]);
    }

private:
    void classify(std::span<const LeafDisc> discs);
    void sum_up();

    int columns_ = 0;
    int rows_ = 0;
    float u_min_ = 0;
    float v_min_ = 0;
    float per_unit_ = 0;
    std::vector<std::uint8_t> cells_;
    std::vector<std::uint32_t> first_disc_;
    std::vector<LeafDisc> cell_discs_;
    std::vector<std::uint32_t> touched_;    ///< summed-area table of the cells that are not empty
    std::vector<std::uint32_t> uncovered_;  ///< and of those that are not covered
};

/// A plane with many discs.
struct WallOccluder {
    LeafPlane plane;
    PlaneRectangle bounds;  ///< of its discs
    PlaneRaster raster;
};

struct Occluders {
    explicit Occluders(const LeafVisibility& leaves);

    std::vector<WallOccluder> walls;
    std::vector<LoneDisc> discs;  ///< all others
};

}  // namespace vmap
