// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the rules answer differently.
#pragma once

#include <vmap/query_vmap.h>

#include <memory>

namespace vmap {

class QueryEngine {
public:
    QueryEngine(const PointCloud& points, const Tree& over_points) : cloud(points), tree(over_points) {}
    virtual ~QueryEngine() = default;
    QueryEngine(const QueryEngine&) = delete;
    QueryEngine& operator=(const QueryEngine&) = delete;

    [[nodiscard]] virtual bool sees(std::uint32_t x, std::uint32_t y) const = 0;
    [[nodiscard]] virtual PairStatus status(std::span<const std::uint32_t> xs, std::span<const std::uint32_t> ys,
                                            QueryCost& cost) const = 0;
    [[nodiscard]] virtual std::optional<PointHit> first_point(const Imath::V3d& from,
                                                              const Imath::V3d& direction) const = 0;
    /// Whether a place in front of point x is reached in a straight line.
    [[nodiscard]] virtual bool reaches(std::uint32_t x, const Imath::V3d& place) const = 0;

    const PointCloud& cloud;
    const Tree& tree;
};

[[nodiscard]] std::unique_ptr<const QueryEngine> make_centroid_engine(const PointCloud& cloud, const Tree& tree,
                                                                      const VisibilityMap& map);

}  // namespace vmap
