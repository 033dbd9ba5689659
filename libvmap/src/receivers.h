// SPDX-License-Identifier: Apache-2.0
/// \file
/// Where indirect light is gathered: the vertices of a grid on every flat patch, refined where the light asks for it,
/// and the middle of every curved group.
#pragma once

#include "surface.h"

#include <array>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <utility>
#include <vector>

namespace vmap {

/// One place that light is gathered at.
struct Receiver {
    Imath::V3f position{0, 0, 0};  ///< on the surface, relative to the cloud's origin
    Imath::V3f normal{0, 0, 1};
    Imath::V2f place{0, 0};  ///< in the patch's plane; flat patches only
    std::uint32_t patch = 0;
    std::uint32_t direction_set = 0;  ///< neighbours have different ones
    bool buried = false;              ///< it lies under its neighbours, and what it sees does not count
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
        bool contact = false;  ///< another patch stands on it or hovers closer than the cell is wide
    };

    /// A vertex of the grid: its receiver and the finest cells that it belongs to.
    struct Vertex {
        std::uint32_t receiver = 0;
        std::uint32_t level = 0;
        bool contact = false;  ///< of one of its cells
    };

    /// - coarsest, finest: edge of the cells at most and, but for a factor of two, at least, world units
    ReceiverGrid(const Surface& surface, std::uint32_t patch, float coarsest, float finest,
                 std::vector<Receiver>& receivers);

    [[nodiscard]] std::uint32_t patch() const { return patch_; }
    [[nodiscard]] const std::vector<Cell>& cells() const { return cells_; }

    [[nodiscard]] bool is_finest(const Cell& cell) const;

    /// Cuts a cell in four and appends the receivers that this needs.
    void cut(std::size_t cell, std::vector<Receiver>& receivers);

    /// The cell that holds a place of the patch's plane, and the bilinear weights of its vertices there.
    [[nodiscard]] std::pair<const Cell*, std::array<float, 4>> locate(const Imath::V2f& place) const;

    /// Calls use(vertex, lattice place) for every vertex, in an order that depends on the grid only.
    template <class Use>
    void for_each_vertex(const Use& use) const {
        for (const std::uint64_t key : order_) use(vertices_.at(key), at_of(key));
    }

    /// The vertex at a place of the finest lattice; null when there is none.
    [[nodiscard]] const Vertex* vertex_at(const Imath::V2i& at) const {
        const auto found = vertices_.find(key_of(at.x, at.y));
        return found == vertices_.end() ? nullptr : &found->second;
    }

    /// Edge of a cell in steps of the finest lattice, and of such a step in world units.
    [[nodiscard]] static int steps_of(std::uint32_t level) { return 1 << (max_level - level); }
    [[nodiscard]] const Imath::V2f& step() const { return step_; }

private:
    [[nodiscard]] static std::uint64_t key_of(int x, int y) {
        return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32) | static_cast<std::uint32_t>(y);
    }
    [[nodiscard]] static Imath::V2i at_of(std::uint64_t key) {
        return {static_cast<int>(key >> 32), static_cast<int>(key & 0xFFFFFFFFU)};
    }
    std::uint32_t vertex(int x, int y, const Cell& cell, std::vector<Receiver>& receivers);
    void finish(Cell& cell, std::vector<Receiver>& receivers);
    [[nodiscard]] Imath::V2f place_of(int x, int y) const;

    const Surface* surface_;
    std::uint32_t patch_;
    float finest_;
    Imath::V2f low_{0, 0};
    Imath::V2f step_{1, 1};  ///< of the finest level
    Imath::V2i count_{1, 1};
    std::vector<Cell> cells_;
    std::unordered_map<std::uint64_t, Vertex> vertices_;
    std::vector<std::uint64_t> order_;  ///< of the vertices, as they were made
};

}  // namespace vmap
