// SPDX-License-Identifier: GPL-3.0-or-later
#include <vmap/patch.h>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "frame.h"
#include "point_field.h"
#include "shapes.h"

namespace vmap::picture {
namespace {

using Imath::V3f;

constexpr std::size_t disc_vertices = 8;
constexpr float least_radius = 0.8F;  ///< of the discs, in spacings
constexpr float most_radius = 2.5F;
constexpr std::size_t sector_count = 6;
constexpr float neighbourhood = 1.5F;  ///< in reaches of the points' interpolation

/// How far the outlines behind the discs reach beyond their points' share, in spacings: no cracks between groups.
constexpr float backing_overlap = 0.5;

void add_polygon(Shapes& result, std::span<const V3f> vertices, const V3f& normal, bool emits, bool curved) {
    Shape shape;
    shape.normal = normal;
    shape.sheet = emits ? 1 : 0;
    shape.emits = emits;
    shape.curved = curved;
    result.shapes.push_back(shape);
    result.polygons.add(vertices);
}

void add_disc(Shapes& result, const V3f& center, const V3f& normal, float radius, bool emits) {
    const V3f u = any_perpendicular(normal) * radius;
    const V3f v = normal.cross(u);
    std::array<V3f, disc_vertices> vertices;
    for (std::size_t i = 0; i < disc_vertices; ++i) {
        const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / disc_vertices;
        vertices[i] = center + u * std::cos(angle) + v * std::sin(angle);
    }
    add_polygon(result, vertices, normal, emits, true);
}

/// Radius with which a point's disc meets those of its neighbours on all sides: the farthest of the nearest neighbours
/// in each sixth of a turn decides. On a side without neighbours the surface ends.
float disc_radius(const PointCloud& cloud, std::uint32_t point, std::span<const std::uint32_t> neighbours) {
    const V3f& normal = cloud.normals[point];
    const V3f u = any_perpendicular(normal);
    const V3f v = normal.cross(u);
    const float spacing = std::sqrt(cloud.areas[point]);
    std::array<float, sector_count> nearest{};
    for (const std::uint32_t i : neighbours) {
        if (i == point || cloud.normals[i].dot(normal) < 0.3F) continue;
        const V3f offset = cloud.positions[i] - cloud.positions[point];
        const float turn = std::atan2(offset.dot(v), offset.dot(u)) / (2 * std::numbers::pi_v<float>)+0.5F;
        const auto sector = std::min(static_cast<std::size_t>(turn * sector_count), sector_count - 1);
        const float distance = offset.length();
        if (nearest[sector] == 0 || distance < nearest[sector]) nearest[sector] = distance;
    }
    const float farthest = *std::max_element(nearest.begin(), nearest.end());
    return std::clamp(0.7F * farthest, least_radius * spacing, most_radius * spacing);
}

/// How far behind the middle of a group its plane must lie to stay under the surface, even where it reaches beyond the
/// points: the deepest point, and on from there as steeply as the steepest of them.
float depth_under(const PointCloud& cloud, std::span<const std::uint32_t> points, const Patch& patch) {
    float depth = 0;
    float slope = 0;
    for (const std::uint32_t i : points) {
        depth = std::max(depth, patch.normal.dot(patch.center - cloud.positions[i]));
        const float cos = std::max(0.3F, patch.normal.dot(cloud.normals[i]));
        slope = std::max(slope, std::sqrt(std::max(0.0F, 1 - cos * cos)) / cos);
    }
    return depth + (0.5F + backing_overlap) * patch.spacing() * slope;
}

/// Distance of the points of a group from its middle at most, along its plane.
float reach_of(const PointCloud& cloud, std::span<const std::uint32_t> points, const Patch& patch) {
    float reach = 0;
    for (const std::uint32_t i : points) reach = std::max(reach, patch.to_plane(cloud.positions[i]).length());
    return reach;
}

/// A vertex of a group's outline moved outwards by the overlap, but not to where sharp corners of outlines end.
V3f backing_vertex(const Patch& patch, const V3f& vertex, float reach) {
    const Imath::V2f place = patch.to_plane(vertex);
    const float overlap = backing_overlap * patch.spacing();
    const float length = std::min(place.length(), reach + 0.5F * patch.spacing()) + overlap;
    return patch.from_plane(place.normalized() * length);
}

}  // namespace

std::vector<std::uint32_t> emission_sheets(const PointCloud& cloud) {
    std::vector<std::uint32_t> sheets(cloud.size(), 0);
    if (cloud.emits())
        for (std::size_t i = 0; i < cloud.size(); ++i)
            sheets[i] = cloud.emission[i].x > 0 || cloud.emission[i].y > 0 || cloud.emission[i].z > 0 ? 1 : 0;
    return sheets;
}

Shapes shapes_of(const PointCloud& cloud, const PointField& field) {
    const PatchSet set = find_patches(cloud);
    std::vector<float> radii(cloud.size(), 0);
    tbb::enumerable_thread_specific<PointField::Workspace> workspaces;
    tbb::parallel_for(std::size_t{0}, set.patches.size(), [&](std::size_t p) {
        if (set.patches[p].flat) return;
        std::vector<std::uint32_t> neighbours;
        for (const std::uint32_t i : set.points_of(set.patches[p])) {
            field.neighbours(cloud.positions[i], neighbourhood, workspaces.local(), neighbours);
            radii[i] = disc_radius(cloud, i, neighbours);
        }
    });

    Shapes result;
    result.point_polygons.resize(cloud.size());
    std::vector<V3f> moved;
    for (std::size_t p = 0; p < set.patches.size(); ++p) {
        const Patch& patch = set.patches[p];
        const std::span<const V3f> outline = set.outlines[p];
        if (patch.flat) {
            for (const std::uint32_t i : set.points_of(patch))
                result.point_polygons[i] = static_cast<std::uint32_t>(result.shapes.size());
            add_polygon(result, outline, patch.normal, patch.emits, false);
            continue;
        }
        for (const std::uint32_t i : set.points_of(patch)) {
            result.point_polygons[i] = static_cast<std::uint32_t>(result.shapes.size());
            add_disc(result, cloud.positions[i], cloud.normals[i], radii[i], patch.emits);
        }
        // The group's own outline closes what gaps the discs of unevenly spread points leave, from just behind them.
        if (patch.point_count < 6) continue;
        const std::span<const std::uint32_t> points = set.points_of(patch);
        const float depth = depth_under(cloud, points, patch);
        const float reach = reach_of(cloud, points, patch);
        moved.clear();
        for (const V3f& v : outline) moved.push_back(backing_vertex(patch, v, reach) - patch.normal * depth);
        add_polygon(result, moved, patch.normal, patch.emits, true);
    }
    return result;
}

}  // namespace vmap::picture
