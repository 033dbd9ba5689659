// SPDX-License-Identifier: Apache-2.0
/// \file
/// The rule `centroid`: whether one leaf sees another. Every builder decides pairs of leaves by this header alone or
/// bit for bit as it does.
///
/// Coordinates are those of the cloud, moved and scaled so that the tree's box has its centre at 0 and a half diagonal
/// of 1: a scene then has the same links in any unit.
///
/// This work is based on:
///   R. Goradia, A. Kanakanti, S. Chandran, A. Datta, "Visibility map for global illumination in point clouds",
///   GRAPHITE 2007 (centroids, averaged normals, tangent plane within R, both occluder walks);
///   J. E. Bresenham, "Algorithm for computer control of a digital plotter", IBM Systems Journal 1965.
#pragma once

#include <vmap/tree.h>

#include <Imath/ImathVec.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

namespace vmap {

/// A tangent plane. Flat leaves whose planes differ by rounding only share one.
struct LeafPlane {
    Imath::V3f normal{0, 0, 1};
    Imath::V3f u{1, 0, 0};  ///< unit, in the plane
    Imath::V3f v{0, 1, 0};  ///< unit, in the plane, at a right angle to u
    float offset = 0;       ///< normal.dot(x) of the plane
    float slab = 0;         ///< what is no farther from the plane than this counts as lying in it
};

/// Where a leaf blocks: the disc of radius R around its centroid in its tangent plane.
struct LeafDisc {
    std::uint32_t plane = 0;  ///< index into LeafVisibility::planes
    float u = 0;              ///< centroid in the plane's coordinates
    float v = 0;
    float radius_squared = 0;
};

/// A place seen from a plane.
struct PlaneCoordinates {
    float u = 0;
    float v = 0;
    float height = 0;  ///< over the plane, positive where its normal points
};

[[nodiscard]] PlaneCoordinates to_plane(const LeafPlane& plane, const Imath::V3f& place);

/// Whether the open segment from a to b, both seen from the disc's plane, crosses the disc. Neither end may lie in the
/// plane. Exchanging the ends may change the last bit of the crossing: order them by leaf.
[[nodiscard]] bool crosses(const LeafPlane& plane, const LeafDisc& disc, const PlaneCoordinates& a,
                           const PlaneCoordinates& b);

/// A disc that a ray meets.
struct DiscHit {
    float t = 0;  ///< along the ray, in lengths of its direction
    std::uint32_t leaf = 0;
};

class LeafVisibility {
public:
    /// The tree is kept by reference.
    explicit LeafVisibility(const Tree& tree);

    /// Whether leaf a sees leaf b: they face each other, and no leaf among the potential occluders blocks the segment
    /// between their centroids. Potential occluders are all leaves on an adaptive tree (found by the seed's ray-sphere
    /// traversal) and the leaves of the cells on the seed's Bresenham walk on a uniform one. Symmetric; false for a==b.
    [[nodiscard]] bool sees(std::uint32_t a, std::uint32_t b) const;

    /// Whether each centroid lies in front of the other leaf's tangent plane and out of its slab.
    [[nodiscard]] bool face_each_other(std::uint32_t a, std::uint32_t b) const;

    /// Whether leaf k's disc crosses the segment between the centroids of a and b.
    [[nodiscard]] bool blocks(std::uint32_t k, std::uint32_t a, std::uint32_t b) const;

    /// Whether leaf k is a potential occluder of a and b.
    [[nodiscard]] bool may_block(std::uint32_t k, std::uint32_t a, std::uint32_t b) const;

    /// Whether any disc crosses the open segment between two places. Works on both kinds of tree.
    [[nodiscard]] bool is_blocked(const Imath::V3f& from, const Imath::V3f& to) const;

    /// The first disc that a ray meets from either side. Works on both kinds of tree.
    ///
    /// - direction: of any length above 0
    [[nodiscard]] std::optional<DiscHit> first_disc(const Imath::V3f& from, const Imath::V3f& direction) const;

    /// Place of the cloud (relative to its origin) in this header's coordinates.
    [[nodiscard]] Imath::V3f to_unit(const Imath::V3d& position) const;
    /// Length in the cloud's units of a length of 1 here; 0 when all points are equal.
    [[nodiscard]] double unit_length() const { return unit_length_; }

    [[nodiscard]] const Tree& tree() const { return tree_; }
    [[nodiscard]] std::size_t size() const { return centroids_.size(); }
    [[nodiscard]] std::span<const Imath::V3f> centroids() const { return centroids_; }
    [[nodiscard]] std::span<const LeafDisc> discs() const { return discs_; }
    [[nodiscard]] std::span<const LeafPlane> planes() const { return planes_; }
    [[nodiscard]] bool walks_cells() const { return !tree_.cells.empty(); }

private:
    struct Sphere {
        Imath::V3f center{0, 0, 0};
        float radius = 0;
    };

    void make_planes();
    void make_spheres();
    void sort_cells();
    [[nodiscard]] bool sees_through_cells(std::uint32_t a, std::uint32_t b) const;
    template <class Test>
    [[nodiscard]] bool any_below(std::uint32_t node, const Imath::V3f& from, const Imath::V3f& to,
                                 const Test& blocks_here) const;

    const Tree& tree_;
    Imath::V3d center_{0, 0, 0};
    double unit_length_ = 0;
    float eps_ = 0;
    std::vector<Imath::V3f> centroids_;
    std::vector<LeafPlane> planes_;
    std::vector<LeafDisc> discs_;
    std::vector<Sphere> spheres_;             ///< around the discs of each node
    std::vector<std::uint32_t> cell_leaves_;  ///< uniform tree: leaves, cell after cell
    std::unordered_map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>> leaves_of_cell_;  ///< range of those
};

}  // namespace vmap
