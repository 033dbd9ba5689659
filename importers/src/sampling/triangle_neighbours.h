// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Which lit triangles go on smoothly in which.
#pragma once

#include "lit_surface.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace vmap {

/// For each triangle the one over the edge from its first corner to its second, second to third, third to first.
using Neighbours = std::vector<std::array<std::uint32_t, 3>>;
inline constexpr std::uint32_t no_neighbour = 0xFFFFFFFF;

/// Area in squares of the spacing below which a part's own direction does not matter to the points: it may be a bump or
/// a fold of a rough surface.
inline constexpr double small_part = 2;

/// Triangles that share an edge as sides of one sheet, where they meet at less than 60 degrees, or, when both are
/// small, 78. Of several it is the one that goes on most straightly.
/// - spacing: mean distance of the points to come, world units
[[nodiscard]] Neighbours find_neighbours(const LitSurface& surface, double spacing);

/// Cosine of the angle up to which triangles go on smoothly.
inline constexpr float smooth_cosine = 0.5F;

/// Triangles that hang together and are coplanar within half a degree.
struct FlatParts {
    std::vector<std::uint32_t> of;         ///< part of each triangle
    std::vector<double> areas;             ///< of each part, world units squared
    std::vector<std::size_t> first{0};     ///< triangle of each part, and the number of triangles
    std::vector<std::uint32_t> triangles;  ///< part after part, the largest of each part first

    [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(areas.size()); }
    [[nodiscard]] std::span<const std::uint32_t> triangles_of(std::uint32_t part) const {
        return {triangles.data() + first[part], triangles.data() + first[part + 1]};
    }
};

[[nodiscard]] FlatParts find_flat_parts(const LitSurface& surface, const Neighbours& neighbours);

/// Normals of the triangles, averaged over a few around where flat parts are small.
[[nodiscard]] std::vector<Imath::V3f> smooth_normals(const LitSurface& surface, const Neighbours& neighbours,
                                                     const FlatParts& flats, double spacing);

/// Numbers of parts, largest area first.
[[nodiscard]] std::vector<std::uint32_t> by_area(std::span<const double> areas);

}  // namespace vmap
