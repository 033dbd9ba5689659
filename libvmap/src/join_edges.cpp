// SPDX-License-Identifier: Apache-2.0
#include "join_edges.h"

#include "shaft.h"

#include <vmap/outline.h>
#include <vmap/polygon_bvh.h>

#include <Imath/ImathBox.h>

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <span>

namespace vmap {
namespace {

using Imath::V2d;
using Imath::V3d;
using Imath::V3f;

/// Sine of the angle of two planes whose common line is still known to a small part of the spacing.
constexpr double least_fold = 0.02;
/// Sine of the angle with the floor at which something is a wall.
constexpr double least_wall_slope = 0.2;
constexpr std::size_t least_part_points = 12;  ///< on either side of a wall that cuts a piece

/// Whether a place in the plane of a piece lies in its outline or at most `margin` outside of it.
bool reaches(const Piece& piece, const Imath::V2f& place, double margin) {
    const V2d q(place);
    for (std::size_t i = 0; i < piece.outline.size(); ++i) {
        const V2d& from = piece.outline[i];
        const V2d along = (piece.outline[(i + 1) % piece.outline.size()] - from).normalized();
        if (V2d(-along.y, along.x).dot(q - from) < -margin) return false;
    }
    return true;
}

/// Where a wall stands on a piece, in the piece's plane: on the line, from `low` to `high` along the line's direction
/// (-inward.y, inward.x).
struct Footprint {
    Edge line;
    double low;
    double high;
};

/// The part of a convex outline at a height over a plane, as the two ends of a segment; none when it does not reach it.
std::optional<std::array<V3d, 2>> slice(std::span<const V3f> outline, const V3d& center, const V3d& normal,
                                        double height) {
    std::array<V3d, 2> ends;
    std::size_t count = 0;
    for (std::size_t i = 0; i < outline.size() && count < 2; ++i) {
        const V3d a(outline[i]);
        const V3d b(outline[(i + 1) % outline.size()]);
        const double from = normal.dot(a - center) - height;
        const double to = normal.dot(b - center) - height;
        if ((from > 0) != (to > 0)) ends.at(count++) = a + (b - a) * (from / (from - to));
    }
    return count == 2 ? std::optional(ends) : std::nullopt;
}

/// The walls that stand on a piece, or go through it.
std::vector<Footprint> footprints(const std::vector<Piece>& pieces, const PolygonSet& outlines, const PolygonBvh& bvh,
                                  std::size_t p) {
    const Patch& floor = pieces[p].patch;
    const V3d normal(floor.normal);
    Imath::Box3f box;
    for (const V3f& v : outlines[p]) box.extendBy(v);
    const float margin = 2 * floor.spacing();
    std::vector<std::uint32_t> near;
    bvh.polygons_in(Shaft::around(box, margin).half_spaces(), near);
    std::sort(near.begin(), near.end());

    std::vector<Footprint> found;
    for (const std::uint32_t other : near) {
        const Patch& wall = pieces[other].patch;
        if (other == p || !wall.flat) continue;
        const V3d wall_normal(wall.normal);
        const V3d across = wall_normal - normal * normal.dot(wall_normal);
        if (across.length() < least_wall_slope) continue;
        // Where the wall is, is told a little above the floor: its own foot may end short of it.
        const double height = 1.5 * static_cast<double>(std::max(floor.spacing(), wall.spacing()));
        const auto ends = slice(outlines[other], V3d(floor.center), normal, height);
        if (!ends) continue;
        const V2d inward = V2d(across.dot(V3d(floor.u)), across.dot(V3d(floor.v))) / across.length();
        const double offset = wall_normal.dot(V3d(wall.center) - V3d(floor.center)) / across.length();
        const V2d along(-inward.y, inward.x);
        std::array<double, 2> at{};
        for (std::size_t i = 0; i < 2; ++i) {
            const V3d q = ends->at(i) - V3d(floor.center);
            at.at(i) = along.dot(V2d(q.dot(V3d(floor.u)), q.dot(V3d(floor.v))));
        }
        found.push_back({{inward, offset}, std::min(at[0], at[1]), std::max(at[0], at[1])});
    }
    return found;
}

/// The side of a convex outline where line.inward.dot(q) > line.offset.
std::vector<V2d> clip(const std::vector<V2d>& outline, const Edge& line) {
    std::vector<V2d> kept;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const V2d& a = outline[i];
        const V2d& b = outline[(i + 1) % outline.size()];
        const double from = line.inward.dot(a) - line.offset;
        const double to = line.inward.dot(b) - line.offset;
        if (from > 0) kept.push_back(a);
        if ((from > 0) != (to > 0)) kept.push_back(a + (b - a) * (from / (from - to)));
    }
    return kept;
}

/// Whether walls on one line hide its two sides from each other all the way across the outline.
bool spans(const std::vector<V2d>& outline, const Edge& line, const std::vector<Footprint>& walls, double spacing) {
    const V2d along(-line.inward.y, line.inward.x);
    double low = std::numeric_limits<double>::max();
    double high = std::numeric_limits<double>::lowest();
    for (const V2d& q : clip(outline, line)) {
        if (std::abs(line.inward.dot(q) - line.offset) > 1e-6 * spacing) continue;
        low = std::min(low, along.dot(q));
        high = std::max(high, along.dot(q));
    }
    if (!(low < high)) return false;
    std::vector<std::array<double, 2>> covered;
    for (const Footprint& wall : walls) {
        const double turn = wall.line.inward.dot(line.inward);
        if (std::abs(turn) < 1 - 1e-5 || std::abs(wall.line.offset - line.offset * turn) > 0.1 * spacing) continue;
        covered.push_back(turn > 0 ? std::array{wall.low, wall.high} : std::array{-wall.high, -wall.low});
    }
    std::sort(covered.begin(), covered.end());
    double reached = low + 1.5 * spacing;
    for (const std::array<double, 2>& part : covered)
        if (part[0] <= reached) reached = std::max(reached, part[1] + 1.5 * spacing);
    return reached >= high;
}

/// The part of a piece on one side of a line; without an outline when it has too few points.
Piece part_of(const PointCloud& cloud, const Piece& whole, const Edge& line) {
    Piece part{whole.patch, {}, {}};
    const std::vector<V2d> flat = project(cloud, whole.points, whole.patch);
    V2d mean(0, 0);
    for (std::size_t i = 0; i < flat.size(); ++i) {
        if (!(line.inward.dot(flat[i]) > line.offset)) continue;
        part.points.push_back(whole.points[i]);
        mean += flat[i];
    }
    if (part.points.size() < least_part_points) return part;
    mean /= static_cast<double>(part.points.size());
    part.outline = clip(whole.outline, line);
    for (V2d& q : part.outline) q -= mean;
    part.patch.center += whole.patch.u * static_cast<float>(mean.x) + whole.patch.v * static_cast<float>(mean.y);
    part.patch.point_count = static_cast<std::uint32_t>(part.points.size());
    part.patch.area = static_cast<float>(area_of(cloud, part.points));
    return part;
}

}  // namespace

void cut_at_walls(const PointCloud& cloud, std::vector<Piece>& pieces) {
    const PolygonSet outlines = outlines_of(pieces);
    const PolygonBvh bvh(outlines);
    std::vector<std::vector<Piece>> parts(pieces.size());
    tbb::parallel_for(std::size_t{0}, pieces.size(), [&](std::size_t p) {
        if (!pieces[p].patch.flat) return;
        const std::vector<Footprint> walls = footprints(pieces, outlines, bvh, p);
        const auto spacing = static_cast<double>(pieces[p].patch.spacing());
        for (const Footprint& wall : walls) {
            if (!spans(pieces[p].outline, wall.line, walls, spacing)) continue;
            Piece one = part_of(cloud, pieces[p], wall.line);
            Piece other = part_of(cloud, pieces[p], {-wall.line.inward, -wall.line.offset});
            if (one.outline.size() < 3 || other.outline.size() < 3) continue;
            parts[p].push_back(std::move(one));
            parts[p].push_back(std::move(other));
            return;
        }
    });
    bool again = false;
    for (std::size_t p = 0; p < parts.size(); ++p) {
        if (parts[p].empty()) continue;
        pieces[p] = std::move(parts[p][0]);
        parts[p].erase(parts[p].begin());
        again = true;
    }
    for (std::vector<Piece>& part : parts)
        pieces.insert(pieces.end(), std::make_move_iterator(part.begin()), std::make_move_iterator(part.end()));
    if (again) cut_at_walls(cloud, pieces);
}

void snap_edges(std::vector<Piece>& pieces) {
    const PolygonSet outlines = outlines_of(pieces);
    const PolygonBvh bvh(outlines);
    std::vector<std::vector<V2d>> snapped(pieces.size());
    std::vector<char> loose(pieces.size(), 0);
    tbb::parallel_for(std::size_t{0}, pieces.size(), [&](std::size_t p) {
        const Piece& piece = pieces[p];
        loose[p] = piece.patch.flat ? 0 : 1;
        if (!piece.patch.flat) return;
        const V3d normal(piece.patch.normal);
        const V3d center(piece.patch.center);
        std::vector<Edge> edges = edges_of(piece.outline);
        std::vector<std::uint32_t> near;
        for (std::size_t e = 0; e < edges.size(); ++e) {
            const V2d& from = piece.outline[e];
            const V2d& to = piece.outline[(e + 1) % edges.size()];
            const std::array<V3d, 2> ends{center + V3d(piece.patch.u) * from.x + V3d(piece.patch.v) * from.y,
                                          center + V3d(piece.patch.u) * to.x + V3d(piece.patch.v) * to.y};
            const double own = static_cast<double>(piece.patch.spacing());
            near.clear();
            Imath::Box3f box;
            box.extendBy(V3f(ends[0]));
            box.extendBy(V3f(ends[1]));
            bvh.polygons_in(Shaft::around(box, 1.5F * piece.patch.spacing()).half_spaces(), near);
            double best = 1.2 * own;
            for (const std::uint32_t other : near) {
                if (other == p || !pieces[other].patch.flat) continue;
                const Patch& wall = pieces[other].patch;
                const V3d wall_normal(wall.normal);
                const V3d across = wall_normal - normal * normal.dot(wall_normal);
                if (across.length() < least_fold) continue;
                // Both ends of the edge within a spacing of the line where the planes cut.
                const double scale = 1 / across.length();
                const double d0 = wall_normal.dot(ends[0] - V3d(wall.center)) * scale;
                const double d1 = wall_normal.dot(ends[1] - V3d(wall.center)) * scale;
                const double distance = std::max(std::abs(d0), std::abs(d1));
                if (distance >= best) continue;
                // The wall itself must reach along the edge, not just its plane.
                const V3f middle((ends[0] + ends[1]) / 2);
                if (!reaches(pieces[other], wall.to_plane(middle), 1.5 * own + static_cast<double>(wall.spacing())))
                    continue;
                best = distance;
                const V2d line_normal(across.dot(V3d(piece.patch.u)) * scale, across.dot(V3d(piece.patch.v)) * scale);
                const double offset = wall_normal.dot(V3d(wall.center) - center) * scale;
                const double sign = line_normal.dot(edges[e].inward) > 0 ? 1 : -1;
                edges[e] = {line_normal * sign, offset * sign};
            }
            if (best < 1.2 * own) continue;
            // Nothing to join with; loose all the same if something lies along the edge, not only around its ends.
            Imath::Box3f inner;
            inner.extendBy(V3f(ends[0] * 0.7 + ends[1] * 0.3));
            inner.extendBy(V3f(ends[0] * 0.3 + ends[1] * 0.7));
            const Shaft along = Shaft::around(inner, 1.5F * piece.patch.spacing());
            near.clear();
            bvh.polygons_in(along.half_spaces(), near);
            if (std::any_of(near.begin(), near.end(),
                            [&](std::uint32_t other) { return other != p && along.may_hold(outlines[other]); }))
                loose[p] = 1;
        }
        std::vector<V2d> outline = outline_of(edges);
        const bool sound =
            outline.size() >= 3 && std::abs(polygon_area(outline) / polygon_area(piece.outline) - 1) < 0.1;
        if (!sound) {
            outline = piece.outline;
            loose[p] = 1;
        }
        snapped[p] = std::move(outline);
    });
    for (std::size_t p = 0; p < pieces.size(); ++p) {
        pieces[p].patch.loose = loose[p] != 0;
        if (!snapped[p].empty()) pieces[p].outline = std::move(snapped[p]);
    }
}

}  // namespace vmap
