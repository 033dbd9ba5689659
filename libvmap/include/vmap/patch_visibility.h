// SPDX-License-Identifier: Apache-2.0
/// \file
/// The rule `patch`: what one piece of surface sees of another. A pair is visible when the whole shaft between the two
/// is free of every patch, so that every point of one sees every point of the other; invisible when that is certain:
/// nothing faces, or one patch cuts the whole shaft; else partial. Every builder decides pairs by this header alone.
///
/// Segments leave a piece of surface a little above it: above a wall by what rounding takes, above a curved group by
/// its thickness or a third of its point spacing, so that neither it nor its neighbours hide its points.
///
/// This work is based on:
///   R. Goradia, A. Kanakanti, S. Chandran, A. Datta, "Visibility map for global illumination in point clouds",
///   GRAPHITE 2007 (what a link promises);
///   E. Haines, J. Wallace, "Shaft culling for efficient ray-traced radiosity", EGWR 1991.
#pragma once

#include <vmap/patch.h>
#include <vmap/patch_shaft.h>
#include <vmap/point_cloud.h>
#include <vmap/polygon_bvh.h>
#include <vmap/tree.h>
#include <vmap/visibility_map.h>

#include <Imath/ImathVec.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vmap {

/// Safe to use from many threads at once.
class PatchVisibility {
public:
    /// All three are kept by reference.
    ///
    /// - tree: over the patches of the set, which are those of the cloud
    PatchVisibility(const PointCloud& cloud, const Tree& tree, const PatchSet& set);
    PatchVisibility(const PatchVisibility&) = delete;
    PatchVisibility& operator=(const PatchVisibility&) = delete;

    /// Whether point x sees point y: they face each other and no patch lies between them. Symmetric.
    [[nodiscard]] bool sees(std::uint32_t x, std::uint32_t y) const;

    /// Whether each of two points lies in front of the other.
    [[nodiscard]] bool points_face(std::uint32_t x, std::uint32_t y) const;

    /// Whether a patch lies between two points that face each other.
    [[nodiscard]] bool is_blocked(std::uint32_t x, std::uint32_t y) const;

    /// Middle of the cloud, relative to its origin. Places and boxes below are relative to it: floats then tell them
    /// apart however far off the origin is.
    [[nodiscard]] const Imath::V3d& middle() const { return middle_; }

    /// What queries need of a point, in one place of memory.
    struct alignas(32) Site {
        Imath::V3f lifted;  ///< where segments leave from it
        Imath::V3f normal;  ///< of its patch if that is flat, else its own
        std::uint32_t leaf = 0;
    };
    [[nodiscard]] const Site& site(std::uint32_t point) const { return sites_[point]; }

    /// Facing of two nodes anywhere in the tree: all or none only if it is so for every pair of their points.
    [[nodiscard]] Facing facing(std::uint32_t a, std::uint32_t b) const;

    /// The shaft between two nodes of patches that face each other wholly.
    [[nodiscard]] PatchShaft shaft(std::uint32_t a, std::uint32_t b) const { return {boxes_[a], boxes_[b]}; }
    /// Whether patch k reaches into the shaft between two nodes.
    [[nodiscard]] bool enters(std::uint32_t k, std::uint32_t a, std::uint32_t b, const PatchShaft& shaft) const;
    /// Whether patch k lies across the segment between the middles of two nodes.
    [[nodiscard]] bool crosses_middle(std::uint32_t k, std::uint32_t a, std::uint32_t b) const;
    /// Whether patch k, which crosses the middle, lies across every segment between two nodes of patches.
    [[nodiscard]] bool covers(std::uint32_t k, std::uint32_t a, std::uint32_t b) const;

    /// Box of all places from where segments leave a node.
    [[nodiscard]] const FramedBox& box(std::uint32_t node) const { return boxes_[node]; }

    /// By so much the tests that bound where segments run take boxes to be larger on every side, world units.
    [[nodiscard]] double box_growth() const { return 2 * eps_; }

    /// Centre of a patch.
    [[nodiscard]] const Imath::V3d& center(std::uint32_t patch) const { return centers_[patch]; }

    /// A disc around a patch's outline, in its plane; u and v from the patch's centre.
    struct Disc {
        double u = 0;
        double v = 0;
        double radius = 0;
    };
    [[nodiscard]] const Disc& disc(std::uint32_t patch) const { return discs_[patch]; }

    /// A patch's outline, grown against cracks, in its plane.
    [[nodiscard]] std::span<const Imath::V3d> outline(std::uint32_t patch) const {
        return std::span(vertices_).subspan(first_vertex_[patch], first_vertex_[patch + 1] - first_vertex_[patch]);
    }

    [[nodiscard]] const PolygonBvh& bvh() const { return bvh_; }
    [[nodiscard]] const PatchSet& set() const { return set_; }
    [[nodiscard]] const Tree& tree() const { return tree_; }
    /// Distance below which things count as touching, world units.
    [[nodiscard]] double eps() const { return eps_; }
    /// Half the diagonal of the tree's box, world units.
    [[nodiscard]] double half_diagonal() const { return half_diagonal_; }

private:
    /// Inside is inwards.dot(x) >= offset.
    struct Edge {
        Imath::V3d inwards;
        double offset;
    };

    void make_sites();
    void grow_outlines();
    void make_boxes();
    [[nodiscard]] std::span<const Edge> edges(std::uint32_t patch) const {
        return std::span(edges_).subspan(first_vertex_[patch], first_vertex_[patch + 1] - first_vertex_[patch]);
    }
    [[nodiscard]] bool may_cross(std::uint32_t k, std::uint32_t a, std::uint32_t b) const;
    [[nodiscard]] Facing in_front(std::uint32_t of, std::uint32_t node) const;

    const PointCloud& cloud_;
    const Tree& tree_;
    const PatchSet& set_;
    Imath::V3d middle_{0, 0, 0};
    double half_diagonal_ = 0;
    double eps_ = 0;
    std::vector<Site> sites_;
    std::vector<Imath::V3d> centers_;
    std::vector<float> lift_;  ///< of each patch
    std::vector<std::size_t> first_vertex_;
    std::vector<Imath::V3d> vertices_;
    std::vector<Edge> edges_;  ///< one per vertex, from it to the next
    std::vector<Disc> discs_;
    std::vector<Imath::V3d> normals_;
    std::vector<double> offsets_;  ///< of the patches' planes
    std::vector<FramedBox> boxes_;
    PolygonBvh bvh_;
};

}  // namespace vmap
