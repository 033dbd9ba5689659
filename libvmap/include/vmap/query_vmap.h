// SPDX-License-Identifier: Apache-2.0
/// \file
/// The four questions that a visibility map answers: is a point visible from another, what do points around one place
/// see of points around another, what does a ray meet first, is a point in the umbra of a light.
///
/// This work is based on:
///   R. Goradia, A. Kanakanti, S. Chandran, A. Datta, "Visibility map for global illumination in point clouds",
///   GRAPHITE 2007.
#pragma once

#include <vmap/light_source.h>
#include <vmap/patch.h>
#include <vmap/point_cloud.h>
#include <vmap/tree.h>
#include <vmap/visibility_map.h>

#include <Imath/ImathVec.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace vmap {

/// What a query did to find its answer.
struct QueryCost {
    std::uint64_t primitive_tests = 0;  ///< questions of the kind "does this one see that one"
};

/// The point of the cloud that a ray meets.
struct PointHit {
    std::uint32_t point = 0;
    double distance = 0;  ///< from the ray's origin to where it meets the surface, world units
};

class QueryEngine;

/// Safe to use from many threads at once.
class VmapQuery {
public:
    /// All are kept by reference and belong together: the tree is that of the cloud, the map that of the tree.
    ///
    /// - patches: those that the tree was made of; read under rule `patch` only
    /// - throws UsageError for a tree of more than 262 144 leaves, whose pairs would not fit into memory
    VmapQuery(const PointCloud& cloud, const Tree& tree, const VisibilityMap& map, const PatchSet& patches);
    ~VmapQuery();
    VmapQuery(VmapQuery&&) noexcept;
    VmapQuery& operator=(VmapQuery&&) noexcept;

    /// Query 1: whether point x is visible from point y.
    ///
    /// - x, y: indices into the cloud
    [[nodiscard]] bool sees(std::uint32_t x, std::uint32_t y) const;

    /// Query 2: what the points xs see of the points ys. The cost does not grow with the number of pairs. Under rule
    /// `patch` no point is tested, and partial also means that the map alone cannot tell.
    ///
    /// - xs, ys: indices into the cloud, at least one each
    [[nodiscard]] PairStatus status(std::span<const std::uint32_t> xs, std::span<const std::uint32_t> ys,
                                    QueryCost* cost = nullptr) const;

    /// Query 3: the first object along a ray.
    ///
    /// - from: world position
    /// - direction: of any length above 0
    [[nodiscard]] std::optional<PointHit> first_point(const Imath::V3d& from, const Imath::V3d& direction) const;

    /// Query 4: what light reaches point x of a light without a surface: visible, or invisible in the light's umbra,
    /// behind the point's surface and outside of a spot's cone.
    [[nodiscard]] PairStatus light_status(std::uint32_t x, const LightSource& light) const;

    /// Query 4 for a light with a surface: partial is the penumbra. Under rule `patch` points are tested where the map
    /// cannot tell.
    ///
    /// - emitters: the points of the light, indices into the cloud, at least one
    [[nodiscard]] PairStatus light_status(std::uint32_t x, std::span<const std::uint32_t> emitters,
                                          QueryCost* cost = nullptr) const;

    /// The point of the cloud next to a place.
    ///
    /// - place: world position
    /// - returns no_index for an empty cloud
    [[nodiscard]] std::uint32_t nearest_point(const Imath::V3d& place) const;

    /// The points within a distance of a place, world units, ascending.
    [[nodiscard]] std::vector<std::uint32_t> points_around(const Imath::V3d& place, double distance) const;

private:
    std::unique_ptr<const QueryEngine> engine_;
};

}  // namespace vmap
