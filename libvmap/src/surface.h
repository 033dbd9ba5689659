// SPDX-License-Identifier: Apache-2.0
/// \file
/// What every stage of the light looks at: the cloud as patches, the rays' view of them, and the distances below which
/// things count as touching.
#pragma once

#include "pencil_tracer.h"

#include <vmap/patch.h>
#include <vmap/point_cloud.h>
#include <vmap/polygon_bvh.h>

#include <Imath/ImathBox.h>

#include <cstdint>
#include <vector>

namespace vmap {

/// A few dozen neighbouring points of one patch: one range of PatchSet::point_order.
struct Tile {
    std::uint32_t patch = 0;
    std::uint32_t first_point = 0;
    std::uint32_t point_count = 0;
    Imath::Box3f bounds;
};

struct Surface {
    explicit Surface(const PointCloud& points);

    const PointCloud& cloud;
    PatchSet set;             ///< the points of a tile are neighbours in point_order
    std::vector<Tile> tiles;  ///< patch after patch
    PolygonBvh bvh;           ///< over the outlines, those of curved groups grown against cracks
    PencilTracer pencils;     ///< over the same outlines, for rays from one place
    PolygonBvh loose;         ///< over the outlines of loose patches, grown by a spacing: what a ray slipped between
    std::vector<std::uint32_t> loose_patches;  ///< that its polygons belong to
    Imath::Box3f bounds;                       ///< of all points
    float diagonal = 0;                        ///< of the bounds, world units; never 0

    /// What a ray meets that found nothing, or only the back of something, because patches leave a crack: the nearest
    /// loose patch that faces it.
    [[nodiscard]] RayHit hit_in_crack(const Ray& ray) const;

    /// Normal that light is gathered over: a flat patch's own, else the point's.
    [[nodiscard]] const Imath::V3f& normal_of(const Patch& patch, std::uint32_t point) const {
        return patch.flat ? patch.normal : cloud.normals[point];
    }
    /// How far above the surface rays of a patch start, world units: far enough to leave its neighbours.
    [[nodiscard]] float gather_offset(const Patch& patch) const {
        return patch.flat ? 2e-5F * diagonal : 0.05F * patch.spacing();
    }
};

}  // namespace vmap
