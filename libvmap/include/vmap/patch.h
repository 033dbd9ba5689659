// SPDX-License-Identifier: Apache-2.0
/// \file
/// Surface patches: the points of a cloud grouped into pieces of surface. A flat piece, as large as flatness permits (a
/// whole wall), is one patch with its true outline; curved surface falls into small groups with a bounded range of
/// normals, each with the outline of its points in their mean plane. Rays, shafts and light see patches, never points.
#pragma once

#include <vmap/point_cloud.h>
#include <vmap/polygon_set.h>

#include <Imath/ImathVec.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vmap {

/// One piece of surface and its frame: world = center + u * x + v * y + normal * z, relative to the cloud's origin.
struct Patch {
    Imath::V3f center{0, 0, 0};     ///< mean of its points, in its plane
    Imath::V3f normal{0, 0, 1};     ///< unit, towards the lit side
    Imath::V3f u{1, 0, 0};          ///< unit, in the plane
    Imath::V3f v{0, 1, 0};          ///< normal x u
    std::uint32_t first_point = 0;  ///< its points are one range of PatchSet::point_order
    std::uint32_t point_count = 0;
    float area = 0;      ///< sum of the areas of its points
    bool flat = false;   ///< planar with a true outline; else a small group of a curved surface
    bool loose = false;  ///< an edge adjoins another patch without lying on a common line: a ray may slip between them
    bool emits = false;  ///< every point emits, or none does

    /// Mean distance of neighbouring points, world units.
    [[nodiscard]] float spacing() const;
    /// Plane coordinates (x, y) of a place.
    [[nodiscard]] Imath::V2f to_plane(const Imath::V3f& p) const { return {(p - center).dot(u), (p - center).dot(v)}; }
    [[nodiscard]] Imath::V3f from_plane(const Imath::V2f& q) const { return center + u * q.x + v * q.y; }
};

struct PatchSet {
    std::vector<Patch> patches;
    PolygonSet outlines;                     ///< one per patch, counter-clockwise seen from its lit side
    std::vector<std::uint32_t> point_order;  ///< indices into the cloud, patch after patch

    [[nodiscard]] std::span<const std::uint32_t> points_of(const Patch& patch) const {
        return std::span(point_order).subspan(patch.first_point, patch.point_count);
    }
};

struct PatchConfig {
    std::size_t group_points = 32;    ///< a curved group has at most so many points
    float group_normal_range = 0.4F;  ///< and its normals differ by at most about this much, radians
    float lamp_normal_range = 0.2F;   ///< the same of a group that emits: its shape shows in all the light it sends
};

/// Groups every point of the cloud into exactly one patch. Deterministic at any number of threads.
///
/// What is promised of a flat patch: its points lie within a thousandth of their spacing of its plane, their normals
/// within 2e-3 radians of its normal; the area of its outline equals the sum of their areas, up to the shift of edges
/// onto the lines where neighbouring planes cut it.
[[nodiscard]] PatchSet find_patches(const PointCloud& cloud, const PatchConfig& config = {});

}  // namespace vmap
