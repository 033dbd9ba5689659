// SPDX-License-Identifier: Apache-2.0
/// \file
/// First hits of many rays from one place. Seen from a fixed place a polygon is a cone of directions bounded by planes:
/// a ray meets it when a few scalar products have the right sign. The few polygons that hold most of the surface are
/// tried this way, many rays at once; the small ones stay in a hierarchy.
#pragma once

#include "gather_directions.h"

#include <vmap/polygon_bvh.h>
#include <vmap/polygon_set.h>

#include <Imath/ImathVec.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vmap {

class PencilTracer {
public:
    PencilTracer() = default;

    /// - dilation: of every polygon, world units, as PolygonBvhConfig has it
    PencilTracer(const PolygonSet& polygons, std::span<const float> dilation);

    /// The nearest polygon of every ray from an origin. Of two sheets in one place the one that faces the ray is hit.
    ///
    /// - frame: of the directions; all of them lie above its z = 0
    /// - hits: one per direction
    void first_hits(const Imath::V3f& origin, const NormalFrame& frame, const DirectionSet& directions,
                    std::span<RayHit> hits) const;

    /// A polygon as a receiver sees it, in the receiver's frame: a direction d meets it when edge.dot(d) >= 0 for all
    /// of its edges, at the distance 1 / plane.dot(d) if that is positive.
    struct View {
        Imath::V3f plane;
        std::uint32_t first_edge = 0;
        std::uint32_t edge_count = 0;
    };

private:
    struct Edge {
        Imath::V3f normal;
        float offset;
    };
    struct Large {
        std::uint32_t polygon = 0;
        std::uint32_t first_edge = 0;
        std::uint32_t edge_count = 0;
        Imath::V3f normal;
        float offset = 0;
        std::vector<Imath::V3f> vertices;
    };

    void add_large(std::uint32_t index, std::span<const Imath::V3f> vertices, float dilation);

    std::vector<Large> large_;
    std::vector<Edge> edges_;
    PolygonBvh small_;
    std::vector<std::uint32_t> small_index_;  ///< of small_'s polygons in the whole set
    float coincidence_ = 0;
};

}  // namespace vmap
