// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The nearest neighbours of every point of a cloud.
#pragma once

#include "for_each_point.h"

#include <Imath/ImathVec.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace vmap {

/// For each point the same number of others, the nearest first.
class Neighbours {
public:
    Neighbours(std::vector<std::uint32_t> indices, std::size_t per_point)
        : indices_(std::move(indices)), per_point_(per_point) {}

    [[nodiscard]] std::span<const std::uint32_t> of(std::size_t point) const {
        return std::span(indices_).subspan(point * per_point_, per_point_);
    }
    /// The nearest ones only.
    [[nodiscard]] std::span<const std::uint32_t> of(std::size_t point, std::size_t most) const {
        return of(point).first(std::min(most, per_point_));
    }
    [[nodiscard]] std::size_t per_point() const { return per_point_; }

private:
    std::vector<std::uint32_t> indices_;
    std::size_t per_point_;
};

/// Searches with a kd-tree of CGAL.
/// - positions: finite, no two the same
/// - per_point: wanted; fewer where the cloud has not so many other points
[[nodiscard]] Neighbours find_neighbours(std::span<const Imath::V3f> positions, std::size_t per_point,
                                         const Watch& watch = {});

/// Mean distance of a point's six nearest neighbours; in an even spread that is the distance of neighbours.
[[nodiscard]] double local_spacing(const Neighbours& neighbours, std::span<const Imath::V3f> positions,
                                   std::size_t point);

}  // namespace vmap
