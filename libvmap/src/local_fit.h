// SPDX-License-Identifier: Apache-2.0
/// \file
/// Irradiance on flat patches between the receivers: around every receiver a quadratic is fitted to the neighbours that
/// it sees along the surface, which takes the noise out without flattening the light, and between receivers the
/// quadratics of a cell's corners are blended. All of it is linear in the values at the receivers.
///
/// This work is based on:
///   A. Savitzky, M. J. E. Golay, "Smoothing and differentiation of data by simplified least squares procedures", 1964;
///   W. H. Cleveland, "Robust locally weighted regression and smoothing scatterplots", JASA 1979.
#pragma once

#include "receivers.h"

#include <Imath/ImathColor.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace vmap {

/// A quadratic in the patch's plane around a receiver's place, per channel:
/// c[0] + c[1] x + c[2] y + c[3] x^2 + c[4] xy + c[5] y^2, x and y in world units.
using Quadratic = std::array<Imath::C3f, 6>;

/// Where a place lies among the receivers of its patch.
struct FieldPlace {
    std::array<std::uint32_t, 4> receiver{};
    std::array<float, 4> weight{};
    Imath::V2f place{0, 0};
};

class LocalFit {
public:
    /// - receivers: all of them; those of the grids are fitted
    LocalFit(const Surface& surface, std::span<const ReceiverGrid> grids, std::span<const Receiver> receivers);

    /// The fitted quadratic of every receiver; those of no grid keep their value.
    /// - values: three per receiver
    [[nodiscard]] std::vector<Quadratic> fit(std::span<const float> values) const;

    /// The blend of the corners' quadratics.
    [[nodiscard]] Imath::C3f value_at(const FieldPlace& place, std::span<const Quadratic> field) const;

    /// - careful: where something stands on the cell, only the corners count that the place sees along the surface
    [[nodiscard]] FieldPlace locate(const ReceiverGrid& grid, const Imath::V2f& place, bool careful) const;

private:
    /// Least-squares weights of one receiver: coefficient k is the sum of weight[6 i + k] times the i-th neighbour.
    struct Stencil {
        std::uint32_t first = 0;
        std::uint32_t count = 0;
    };

    struct Neighborhood;
    [[nodiscard]] Neighborhood neighborhood(const ReceiverGrid& grid, const ReceiverGrid::Vertex& vertex,
                                            const Imath::V2i& at, int window) const;
    struct GridStencils;
    void add_stencil(const ReceiverGrid& grid, const ReceiverGrid::Vertex& vertex, const Imath::V2i& at,
                     GridStencils& made) const;

    const Surface* surface_;
    std::span<const Receiver> receivers_;
    std::vector<Stencil> stencils_;
    std::vector<std::uint32_t> neighbors_;
    std::vector<std::array<float, 6>> weights_;  ///< one per neighbour
};

}  // namespace vmap
