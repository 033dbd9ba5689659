// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a picture is drawn from: flat convex polygons, made from the triangles of a scene or from the points alone.
#pragma once

#include <vmap/point_cloud.h>
#include <vmap/polygon_set.h>
#include <vmap/surface_shading.h>

#include <Imath/ImathVec.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vmap::picture {

class PointField;

/// Sheets keep light apart that geometry alone would mix: a place takes light from points of its own sheet only.
inline constexpr std::uint32_t any_sheet = 0xFFFFFFFFU;

/// What a polygon is apart from its outline.
struct Shape {
    Imath::V3f normal{0, 0, 0};  ///< unit, of the front; zero when it has no area and is not drawn
    std::uint32_t sheet = any_sheet;
    bool emits = false;
    bool has_back = false;  ///< points may lie on its back too; else the back is black
    bool may_be_cut = false;
    bool curved = false;  ///< a rough piece of a curved surface that is known by its points only
};

struct Shapes {
    PolygonSet polygons;  ///< relative to the cloud's origin, counter-clockwise seen from the front
    std::vector<Shape> shapes;
    std::vector<std::uint32_t> point_sheets;    ///< of each point; only of a scene's shapes
    std::vector<std::uint32_t> point_polygons;  ///< that each point is on; empty when that is not known
};

/// One polygon per triangle of the scene, numbered as its faces are.
/// - throws UsageError when the cloud's faces do not lie on the scene's
[[nodiscard]] Shapes shapes_of(const Scene& scene, const PointCloud& cloud);

/// What keeps points apart that no scene tells apart: 1 for points that emit, else 0.
[[nodiscard]] std::vector<std::uint32_t> emission_sheets(const PointCloud& cloud);

/// Outlines of flat parts, and a small disc for each point of curved ones.
/// - field: of the cloud with its emission_sheets
[[nodiscard]] Shapes shapes_of(const PointCloud& cloud, const PointField& field);

}  // namespace vmap::picture
