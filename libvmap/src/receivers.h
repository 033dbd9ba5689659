// SPDX-License-Identifier: Apache-2.0
/// \file
/// Where indirect light is gathered, and how it is carried from there to any place of the surface: the vertices of a
/// grid on every flat patch, refined where the light asks for it, and the middle of every curved group.
#pragma once

#include "surface.h"

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace vmap {

/// One place that light is gathered at.
struct Receiver {
    Imath::V3f position{0, 0, 0};  ///< on the surface, relative to the cloud's origin
    Imath::V3f normal{0, 0, 1};
    std::uint32_t patch = 0;
};

/// A value anywhere is the weighted sum of the values at a few receivers.
struct Weights {
    std::array<std::uint32_t, 4> receiver{};
    std::array<float, 4> weight{};
};

/// The receivers of one flat patch: a grid of cells, some of them cut in four, some of those again.
class ReceiverGrid {
public:
    static constexpr std::uint32_t max_level = 3;

    struct Cell {
        Imath::V2i at{0, 0};            ///< lower corner, in steps of the finest level
        std::uint32_t level = 0;        ///< 0 is coarsest
        std::uint32_t first_child = 0;  ///< 0 for a cell that is not cut
        std::array<std::uint32_t, 4> vertex{};
        bool contact = false;  ///< another patch stands on it
    };

    /// - cell_size: of the coarsest cells, world units
    ReceiverGrid(const Surface& surface, std::uint32_t patch, float cell_size, std::vector<Receiver>& receivers);

    [[nodiscard]] const std::vector<Cell>& cells() const { return cells_; }

    /// Cuts a cell in four and appends the receivers that this needs.
    void cut(std::size_t cell, std::vector<Receiver>& receivers);

    /// Bilinear weights at a place in the patch's plane, and the cell that holds it.
    [[nodiscard]] std::pair<Weights, const Cell*> weights_at(const Imath::V2f& place) const;

private:
    std::uint32_t vertex(int x, int y, std::vector<Receiver>& receivers);
    void finish(Cell& cell, std::vector<Receiver>& receivers);
    [[nodiscard]] Imath::V2f place_of(int x, int y) const;

    const Surface* surface_;
    std::uint32_t patch_;
    Imath::V2f low_{0, 0};
    Imath::V2f step_{1, 1};  ///< of the finest level
    Imath::V2i count_{1, 1};
    std::vector<Cell> cells_;
    std::map<std::pair<int, int>, std::uint32_t> vertices_;
};

}  // namespace vmap
