// SPDX-License-Identifier: Apache-2.0
#include "curved_groups.h"
#include "flat_regions.h"
#include "join_edges.h"

#include <vmap/outline.h>
#include <vmap/patch.h>

#include <tbb/parallel_for.h>

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
    cut_into_groups(cloud, flat.rest, config.group_points, emits ? config.lamp_normal_range : config.group_normal_range,
                    pieces);
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

    for (Piece& piece : pieces) piece.patch.point_count = static_cast<std::uint32_t>(piece.points.size());
    cut_at_walls(cloud, pieces);

    PatchSet set;
    set.point_order.reserve(cloud.size());
    for (Piece& piece : pieces) {
        piece.patch.first_point = static_cast<std::uint32_t>(set.point_order.size());
        set.point_order.insert(set.point_order.end(), piece.points.begin(), piece.points.end());
    }
    snap_edges(pieces);
    set.outlines = outlines_of(pieces);
    for (const Piece& piece : pieces) set.patches.push_back(piece.patch);
    return set;
}

}  // namespace vmap
