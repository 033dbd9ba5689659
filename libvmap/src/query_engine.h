// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the rules answer differently.
#pragma once

#include <vmap/leaf_ranges.h>
#include <vmap/query_vmap.h>

#include <memory>
#include <vector>

namespace vmap {

class QueryEngine {
public:
    QueryEngine(const PointCloud& points, const Tree& over_points)
        : cloud(points), tree(over_points), ranges(leaf_ranges(over_points)) {}
    virtual ~QueryEngine() = default;
    QueryEngine(const QueryEngine&) = delete;
    QueryEngine& operator=(const QueryEngine&) = delete;

    [[nodiscard]] virtual bool sees(std::uint32_t x, std::uint32_t y) const = 0;
    [[nodiscard]] virtual PairStatus status(std::span<const std::uint32_t> xs, std::span<const std::uint32_t> ys,
                                            QueryCost& cost) const = 0;
    /// What point x sees of a light's points: the truth about them, where `status` may say partial without a look.
    [[nodiscard]] virtual PairStatus light_status(std::uint32_t x, std::span<const std::uint32_t> emitters,
                                                  QueryCost& cost) const {
        return status({&x, 1}, emitters, cost);
    }
    [[nodiscard]] virtual std::optional<PointHit> first_point(const Imath::V3d& from,
                                                              const Imath::V3d& direction) const = 0;
    /// Whether a place in front of point x is reached in a straight line.
    [[nodiscard]] virtual bool reaches(std::uint32_t x, const Imath::V3d& place) const = 0;

    const PointCloud& cloud;
    const Tree& tree;
    const std::vector<LeafRange> ranges;

protected:
    [[nodiscard]] virtual std::uint32_t leaf_of(std::uint32_t point) const = 0;

    /// The leaves of some points, each once, ascending.
    [[nodiscard]] std::vector<std::uint32_t> leaves_of(std::span<const std::uint32_t> points) const;

    /// The smallest node that holds all of some leaves.
    [[nodiscard]] std::uint32_t node_around(const std::vector<std::uint32_t>& leaves) const;
};

[[nodiscard]] std::unique_ptr<const QueryEngine> make_centroid_engine(const PointCloud& cloud, const Tree& tree,
                                                                      const VisibilityMap& map);
[[nodiscard]] std::unique_ptr<const QueryEngine> make_patch_engine(const PointCloud& cloud, const Tree& tree,
                                                                   const VisibilityMap& map, const PatchSet& set);

}  // namespace vmap
