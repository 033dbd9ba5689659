// SPDX-License-Identifier: Apache-2.0
#include "flat_regions.h"

#include <vmap/outline.h>
#include <vmap/patch.h>
#include <vmap/polygon_bvh.h>

#include <Imath/ImathBox.h>

#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <unordered_map>

namespace vmap {
namespace {

using Imath::V2d;
using Imath::V3d;
using Imath::V3f;
using Indices = std::vector<std::uint32_t>;

constexpr std::size_t least_patch_points = 24;  ///< a flat piece with fewer is treated as a curved group

/// A patch before its points have their place in the common order.
struct Piece {
    Patch patch;
    Indices points;
    std::vector<V2d> outline;  ///< in the patch's frame
};

double area_of(const PointCloud& cloud, std::span<const std::uint32_t> points) {
    double area = 0;
    for (const std::uint32_t i : points) area += static_cast<double>(cloud.areas[i]);
    return area;
}

V3d any_perpendicular(const V3d& n) {
    return n.cross(std::abs(n.x) < 0.6 ? V3d(1, 0, 0) : V3d(0, 1, 0)).normalized();
}

/// Frame of a plane with u along the given direction.
Patch make_patch(const V3d& center, const V3d& normal, const V3d& u, double area, bool flat) {
    Patch patch;
    patch.center = V3f(center);
    patch.normal = V3f(normal);
    patch.u = V3f(u);
    patch.v = V3f(normal.cross(u));
    patch.area = static_cast<float>(area);
    patch.flat = flat;
    return patch;
}

std::vector<V2d> project(const PointCloud& cloud, std::span<const std::uint32_t> points, const Patch& patch) {
    std::vector<V2d> flat(points.size());
    const V3d center(patch.center);
    const V3d u(patch.u);
    const V3d v(patch.v);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const V3d p = V3d(cloud.positions[points[i]]) - center;
        flat[i] = {p.dot(u), p.dot(v)};
    }
    return flat;
}

/// Connected components of points in a plane: cells of a grid that touch, side or corner.
std::vector<Indices> components(const PointCloud& cloud, const FlatRegion& region, double spacing) {
    const V3d u = any_perpendicular(region.normal);
    const Patch frame = make_patch(region.center, region.normal, u, 0, true);
    const std::vector<V2d> flat = project(cloud, region.points, frame);
    const double cell = 2 * spacing;
    constexpr std::uint32_t unassigned = 0xFFFFFFFFU;
    const auto key = [](std::int64_t x, std::int64_t y) { return (x * (std::int64_t{1} << 32)) + (y & 0xFFFFFFFF); };
    std::unordered_map<std::int64_t, std::uint32_t> component_of;
    std::vector<std::int64_t> cell_of(flat.size());
    for (std::size_t i = 0; i < flat.size(); ++i) {
        cell_of[i] = key(std::llround(flat[i].x / cell), std::llround(flat[i].y / cell));
        component_of.emplace(cell_of[i], unassigned);
    }
    std::vector<Indices> result;
    std::vector<std::int64_t> stack;
    for (std::size_t i = 0; i < flat.size(); ++i) {
        std::uint32_t& own = component_of[cell_of[i]];
        if (own == unassigned) {
            own = static_cast<std::uint32_t>(result.size());
            result.emplace_back();
            stack.push_back(cell_of[i]);
            while (!stack.empty()) {
                const std::int64_t at = stack.back();
                stack.pop_back();
                const std::int64_t x = at >> 32;
                const auto y = static_cast<std::int64_t>(static_cast<std::int32_t>(at & 0xFFFFFFFF));
                for (std::int64_t dx = -1; dx <= 1; ++dx)
                    for (std::int64_t dy = -1; dy <= 1; ++dy) {
                        const auto next = component_of.find(key(x + dx, y + dy));
                        if (next == component_of.end() || next->second != unassigned) continue;
                        next->second = own;
                        stack.push_back(next->first);
                    }
            }
        }
        result[component_of[cell_of[i]]].push_back(region.points[i]);
    }
    return result;
}

/// Cuts connected points of one plane into pieces with a convex outline; what is too small goes to `rest`.
class FlatCutter {
public:
    FlatCutter(const PointCloud& cloud, const FlatRegion& region) : cloud_(cloud), region_(region) {}

    void cut(Indices points, std::vector<Piece>& pieces, Indices& rest) {
        const double area = area_of(cloud_, points);
        const double spacing = std::sqrt(area / static_cast<double>(points.size()));
        if (points.size() < least_patch_points) {
            rest.insert(rest.end(), points.begin(), points.end());
            return;
        }
        // The frame follows the piece's sides, and so do the cuts.
        Patch frame = make_patch(region_.center, region_.normal, any_perpendicular(region_.normal), area, true);
        std::vector<V2d> flat = project(cloud_, points, frame);
        const V2d side = main_direction(flat);
        frame = make_patch(center_of(points), region_.normal,
                           (V3d(frame.u) * side.x + V3d(frame.v) * side.y).normalized(), area, true);
        flat = project(cloud_, points, frame);
        if (std::optional<std::vector<V2d>> outline = fit_outline(flat, area, spacing)) {
            pieces.push_back({frame, std::move(points), std::move(*outline)});
            return;
        }
        const OutlineCut line = best_cut(flat, spacing);
        std::array<Indices, 2> halves;
        for (std::size_t i = 0; i < points.size(); ++i)
            halves[flat[i][line.axis] > line.position ? 1 : 0].push_back(points[i]);
        if (halves[0].empty() || halves[1].empty()) {
            rest.insert(rest.end(), points.begin(), points.end());
            return;
        }
        for (Indices& half : halves) cut(std::move(half), pieces, rest);
    }

private:
    /// The direction that most of the hull's border follows, straight or at a right angle: the sides of an L, not the
    /// slope across its notch.
    static V2d main_direction(const std::vector<V2d>& flat) {
        const std::vector<V2d> hull = convex_hull(flat);
        const auto side = [&](std::size_t i) { return hull[(i + 1) % hull.size()] - hull[i]; };
        // Edges near a direction, turned by right angles onto it, sum to the line between the ends of a side: the small
        // zigzag of the points cancels.
        V2d best(1, 0);
        for (std::size_t i = 0; i < hull.size(); ++i) {
            const V2d direction = side(i).normalized();
            V2d along(0, 0);
            for (std::size_t k = 0; k < hull.size(); ++k) {
                V2d edge = side(k);
                for (int turn = 0; turn < 4; ++turn) {
                    if (edge.dot(direction) > 0.985 * edge.length()) along += edge;  // within ten degrees
                    edge = V2d(-edge.y, edge.x);
                }
            }
            if (along.length() > best.length() || i == 0) best = along;
        }
        return best.length() > 0 ? best.normalized() : V2d(1, 0);
    }

    [[nodiscard]] V3d center_of(const Indices& points) const {
        V3d sum(0);
        for (const std::uint32_t i : points) sum += V3d(cloud_.positions[i]);
        const V3d mean = sum / static_cast<double>(points.size());
        return mean - region_.normal * region_.normal.dot(mean - region_.center);
    }

    const PointCloud& cloud_;
    const FlatRegion& region_;
};

/// Cuts the points of curved surface into groups, bounded in number, extent and range of normals.
class GroupCutter {
public:
    GroupCutter(const PointCloud& cloud, const PatchConfig& config) : cloud_(cloud), config_(config) {}

    void cut(std::span<std::uint32_t> points, std::vector<Piece>& groups) const {
        if (points.empty()) return;
        Imath::Box3f places;
        Imath::Box3f normals;
        for (const std::uint32_t i : points) {
            places.extendBy(cloud_.positions[i]);
            normals.extendBy(cloud_.normals[i]);
        }
        const double area = area_of(cloud_, points);
        const double spacing = std::sqrt(area / static_cast<double>(points.size()));
        const auto reach = static_cast<float>(1.5 * spacing * std::sqrt(static_cast<double>(config_.group_points)));
        const V3f size = places.size();
        const V3f range = normals.size();
        const int place_axis = static_cast<int>(places.majorAxis());
        const int normal_axis = static_cast<int>(normals.majorAxis());
        const float place_excess = size[place_axis] / reach;
        const float normal_excess = range[normal_axis] / config_.group_normal_range;
        const bool small = points.size() <= config_.group_points && place_excess <= 2;
        if (points.size() == 1 || (small && normal_excess <= 1)) {
            groups.push_back(group_of(points, area, spacing));
            return;
        }
        // Points that differ in normal lie on different surfaces or across a crease; else the longer side is cut.
        const bool by_normal = normal_excess > 1 && (small || normal_excess > 4 || normal_excess > place_excess);
        const auto value = [&](std::uint32_t i) {
            return by_normal ? cloud_.normals[i][normal_axis] : cloud_.positions[i][place_axis];
        };
        const float at = by_normal ? normals.center()[normal_axis] : places.center()[place_axis];
        const auto middle =
            std::partition(points.begin(), points.end(), [&](std::uint32_t i) { return value(i) < at; });
        auto count = static_cast<std::size_t>(middle - points.begin());
        if (count == 0 || count == points.size()) count = points.size() / 2;
        if (points.size() > 8192) {
            std::vector<Piece> right;
            tbb::task_group tasks;
            tasks.run([&] { cut(points.subspan(count), right); });
            cut(points.first(count), groups);
            tasks.wait();
            groups.insert(groups.end(), std::make_move_iterator(right.begin()), std::make_move_iterator(right.end()));
        } else {
            cut(points.first(count), groups);
            cut(points.subspan(count), groups);
        }
    }

private:
    [[nodiscard]] Piece group_of(std::span<const std::uint32_t> points, double area, double spacing) const {
        V3d center(0);
        V3d normal(0);
        for (const std::uint32_t i : points) {
            center += V3d(cloud_.positions[i]);
            normal += V3d(cloud_.normals[i]);
        }
        center /= static_cast<double>(points.size());
        normal = normal.length() > 1e-6 ? normal.normalized() : V3d(cloud_.normals[points[0]]).normalized();
        Piece group{make_patch(center, normal, any_perpendicular(normal), area, false), {}, {}};
        group.points.assign(points.begin(), points.end());
        group.outline = rough_outline(project(cloud_, points, group.patch), area, spacing);
        return group;
    }

    const PointCloud& cloud_;
    const PatchConfig& config_;
};

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

/// A line in the plane of a patch: points q with direction-normal inward.dot(q) = offset.
struct Edge {
    V2d inward;
    double offset;
};

std::vector<Edge> edges_of(const std::vector<V2d>& outline) {
    std::vector<Edge> edges;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const V2d along = (outline[(i + 1) % outline.size()] - outline[i]).normalized();
        const V2d inward(-along.y, along.x);
        edges.push_back({inward, inward.dot(outline[i])});
    }
    return edges;
}

/// Vertices where consecutive edges meet; empty when two of them do not.
std::vector<V2d> outline_of(const std::vector<Edge>& edges) {
    std::vector<V2d> outline;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const Edge& a = edges[(i + edges.size() - 1) % edges.size()];
        const Edge& b = edges[i];
        const double turn = a.inward.x * b.inward.y - a.inward.y * b.inward.x;
        if (turn < 1e-3) return {};
        outline.emplace_back((a.offset * b.inward.y - b.offset * a.inward.y) / turn,
                             (b.offset * a.inward.x - a.offset * b.inward.x) / turn);
    }
    return outline;
}

PolygonSet outlines_of(const std::vector<Piece>& pieces) {
    PolygonSet outlines;
    std::vector<V3f> vertices;
    for (const Piece& piece : pieces) {
        vertices.clear();
        for (const V2d& q : piece.outline)
            vertices.emplace_back(V3d(piece.patch.center) + V3d(piece.patch.u) * q.x + V3d(piece.patch.v) * q.y);
        outlines.add(vertices);
    }
    return outlines;
}

/// Moves the edges of flat patches onto the lines where the planes of adjoining patches cut theirs, and onto the edges
/// of adjoining patches of the same plane: walls then meet without a crack, exactly.
void snap_edges(std::vector<Piece>& pieces) {
    const PolygonSet outlines = outlines_of(pieces);
    const PolygonBvh bvh(outlines);
    std::vector<std::vector<V2d>> snapped(pieces.size());
    tbb::parallel_for(std::size_t{0}, pieces.size(), [&](std::size_t p) {
        const Piece& piece = pieces[p];
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
            std::array<HalfSpace, 6> around{};
            for (int axis = 0; axis < 3; ++axis) {
                V3f unit(0);
                unit[axis] = 1;
                const auto margin = static_cast<float>(1.5 * own);
                const auto low = static_cast<float>(std::min(ends[0][axis], ends[1][axis])) - margin;
                const auto high = static_cast<float>(std::max(ends[0][axis], ends[1][axis])) + margin;
                around.at(2 * static_cast<std::size_t>(axis)) = {unit, high};
                around.at(2 * static_cast<std::size_t>(axis) + 1) = {-unit, -low};
            }
            bvh.polygons_in(around, near);
            double best = 1.2 * own;
            for (const std::uint32_t other : near) {
                if (other == p || !pieces[other].patch.flat) continue;
                const Patch& wall = pieces[other].patch;
                const V3d wall_normal(wall.normal);
                const V3d across = wall_normal - normal * normal.dot(wall_normal);
                if (across.length() < 0.2) continue;
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
        }
        std::vector<V2d> outline = outline_of(edges);
        const bool sound =
            outline.size() >= 3 && std::abs(polygon_area(outline) / polygon_area(piece.outline) - 1) < 0.1;
        if (!sound) outline = piece.outline;
        snapped[p] = std::move(outline);
    });
    for (std::size_t p = 0; p < pieces.size(); ++p)
        if (!snapped[p].empty()) pieces[p].outline = std::move(snapped[p]);
}

/// Patches of the points that are alike in emitting or not.
void add_pieces(const PointCloud& cloud, Indices points, bool emits, const PatchConfig& config,
                std::vector<Piece>& pieces) {
    if (points.empty()) return;
    const std::size_t first = pieces.size();
    const double spacing = std::sqrt(area_of(cloud, points) / static_cast<double>(points.size()));
    FlatRegions flat = find_flat_regions(cloud, points, spacing);

    std::vector<std::vector<Piece>> cut(flat.regions.size());
    std::vector<Indices> rest(flat.regions.size());
    tbb::parallel_for(std::size_t{0}, flat.regions.size(), [&](std::size_t i) {
        const FlatRegion& region = flat.regions[i];
        const double own = std::sqrt(area_of(cloud, region.points) / static_cast<double>(region.points.size()));
        FlatCutter cutter(cloud, region);
        for (Indices& part : components(cloud, region, own)) cutter.cut(std::move(part), cut[i], rest[i]);
    });
    for (std::size_t i = 0; i < cut.size(); ++i) {
        pieces.insert(pieces.end(), std::make_move_iterator(cut[i].begin()), std::make_move_iterator(cut[i].end()));
        flat.rest.insert(flat.rest.end(), rest[i].begin(), rest[i].end());
    }
    GroupCutter(cloud, config).cut(flat.rest, pieces);
    for (std::size_t i = first; i < pieces.size(); ++i) pieces[i].patch.emits = emits;
}

}  // namespace

float Patch::spacing() const {
    return std::sqrt(area / static_cast<float>(point_count));
}

PatchSet find_patches(const PointCloud& cloud, const PatchConfig& config) {
    Indices dark;
    Indices glowing;
    for (std::uint32_t i = 0; i < cloud.size(); ++i) {
        const bool emits =
            cloud.emits() && (cloud.emission[i].x > 0 || cloud.emission[i].y > 0 || cloud.emission[i].z > 0);
        (emits ? glowing : dark).push_back(i);
    }
    std::vector<Piece> pieces;
    add_pieces(cloud, std::move(dark), false, config, pieces);
    add_pieces(cloud, std::move(glowing), true, config, pieces);

    PatchSet set;
    set.point_order.reserve(cloud.size());
    for (Piece& piece : pieces) {
        piece.patch.first_point = static_cast<std::uint32_t>(set.point_order.size());
        piece.patch.point_count = static_cast<std::uint32_t>(piece.points.size());
        set.point_order.insert(set.point_order.end(), piece.points.begin(), piece.points.end());
    }
    snap_edges(pieces);
    set.outlines = outlines_of(pieces);
    for (const Piece& piece : pieces) set.patches.push_back(piece.patch);
    return set;
}

}  // namespace vmap
