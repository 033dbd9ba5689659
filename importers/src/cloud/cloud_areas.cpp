// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud_areas.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace vmap {
namespace {

using Imath::V2d;
using Imath::V3d;
using Imath::V3f;

/// A convex polygon about the origin, kept on the origin's side of lines.
class Cell {
public:
    explicit Cell(double half_size)
        : corners_{{-half_size, -half_size}, {half_size, -half_size}, {half_size, half_size}, {-half_size, half_size}} {
    }

    /// Cuts off what lies beyond `distance` in the direction `outwards`, of unit length.
    void cut(const V2d& outwards, double distance) {
        kept_.clear();
        for (std::size_t i = 0; i < corners_.size(); ++i) {
            const V2d& a = corners_[i];
            const V2d& b = corners_[(i + 1) % corners_.size()];
            const double beyond_a = a.dot(outwards) - distance;
            const double beyond_b = b.dot(outwards) - distance;
            if (beyond_a <= 0) kept_.push_back(a);
            if ((beyond_a <= 0) != (beyond_b <= 0)) kept_.push_back(a + (b - a) * (beyond_a / (beyond_a - beyond_b)));
        }
        corners_.swap(kept_);
    }

    [[nodiscard]] double area() const {
        double twice = 0;
        for (std::size_t i = 0; i < corners_.size(); ++i)
            twice += corners_[i].cross(corners_[(i + 1) % corners_.size()]);
        return twice / 2;
    }

private:
    std::vector<V2d> corners_;
    std::vector<V2d> kept_;
};

/// Where a neighbour would lie if the surface between two points were unrolled into the tangent plane of the first:
/// turned about the line in which their tangent planes meet.
V3d unfolded(const V3d& step, const V3d& normal, const V3d& other_normal) {
    constexpr double nearly_flat = 0.94;  // cosine of the angle up to which the projection does
    const double cosine = std::clamp(normal.dot(other_normal), -1.0, 1.0);
    if (cosine > nearly_flat) return step;
    const V3d axis = normal.cross(other_normal).normalized();
    // A point of both planes: from the origin within the first plane, across the line.
    const V3d across = axis.cross(normal);
    const double slope = across.dot(other_normal);
    const V3d hinge = across * (step.dot(other_normal) / slope);
    const V3d arm = step - hinge;
    // The turn that takes other_normal to normal.
    const double sine = -std::sqrt(1 - cosine * cosine);
    return hinge + arm * cosine + axis.cross(arm) * sine + axis * (axis.dot(arm) * (1 - cosine));
}

/// Whether the surface cannot go around a single crease from one point to the other: the sides do not fit, as where a
/// block stands on a floor that goes on beneath it.
bool is_other_sheet(const V3d& step, const V3d& normal, const V3d& other_normal) {
    const V3d along = step.normalized();
    return (normal - along * (2 * along.dot(normal))).dot(other_normal) < 0;
}

class AreaEstimator {
public:
    AreaEstimator(std::span<const V3f> positions, std::span<const V3f> normals, const Neighbours& neighbours)
        : positions_(positions), normals_(normals), neighbours_(neighbours) {}

    [[nodiscard]] double area(std::size_t i) const {
        const double spacing = local_spacing(neighbours_, positions_, i);
        const std::vector<V2d> around = in_tangent_plane(i, reach * spacing);
        Cell cell(reach * spacing);
        for (const V2d& place : around) {
            const double distance = place.length();
            cell.cut(place / distance, distance / 2);
        }
        close_gaps(around, border * spacing, cell);
        // Rounding may leave nothing of a cell between points that nearly coincide.
        const double least = 1e-6 * spacing * spacing;
        return std::max({cell.area(), least, static_cast<double>(std::numeric_limits<float>::min())});
    }

private:
    static constexpr double reach = 2.5;    ///< half the largest cell, in local spacings
    static constexpr double border = 0.25;  ///< distance of a border from the outermost points

    [[nodiscard]] std::vector<V2d> in_tangent_plane(std::size_t i, double most) const {
        constexpr double other_side = -0.5;  // cosine: the neighbour belongs to the back of a thin wall
        const V3d normal(normals_[i]);
        const V3d u = normal.cross(std::abs(normal.x) < 0.6 ? V3d(1, 0, 0) : V3d(0, 1, 0)).normalized();
        const V3d v = normal.cross(u);
        std::vector<V2d> places;
        places.reserve(neighbours_.per_point());
        for (const std::uint32_t j : neighbours_.of(i)) {
            const V3d other(normals_[j]);
            const V3d straight = V3d(positions_[j]) - V3d(positions_[i]);
            if (normal.dot(other) < other_side || is_other_sheet(straight, normal, other)) continue;
            const V3d step = unfolded(straight, normal, other);
            const V2d place(step.dot(u), step.dot(v));
            const double distance = place.length();
            // What lies above the point rather than beside it is another sheet.
            if (distance > 0.2 * step.length() && distance > 0 && distance < 2 * most) places.push_back(place);
        }
        return places;
    }

    /// Where no neighbour lies within a wide angle, lines at the border's distance, at most a right angle apart.
    static void close_gaps(const std::vector<V2d>& around, double distance, Cell& cell) {
        constexpr double widest = 2 * std::numbers::pi / 3;
        std::vector<double> angles;
        angles.reserve(around.size());
        for (const V2d& place : around) angles.push_back(std::atan2(place.y, place.x));
        std::sort(angles.begin(), angles.end());
        if (angles.empty()) angles.push_back(0);
        for (std::size_t k = 0; k < angles.size(); ++k) {
            const double from = angles[k];
            const double to = k + 1 < angles.size() ? angles[k + 1] : angles[0] + 2 * std::numbers::pi;
            if (to - from < widest) continue;
            const int lines = static_cast<int>(std::ceil((to - from) / (std::numbers::pi / 2))) - 1;
            for (int line = 1; line <= lines; ++line) {
                const double angle = from + (to - from) * line / (lines + 1);
                cell.cut({std::cos(angle), std::sin(angle)}, distance);
            }
        }
    }

    std::span<const V3f> positions_;
    std::span<const V3f> normals_;
    const Neighbours& neighbours_;
};

}  // namespace

std::vector<float> estimate_areas(std::span<const V3f> positions, std::span<const V3f> normals,
                                  const Neighbours& neighbours, const Watch& watch) {
    std::vector<float> areas(positions.size());
    const AreaEstimator estimator(positions, normals, neighbours);
    for_each_point(positions.size(), watch, [&](std::size_t i) { areas[i] = static_cast<float>(estimator.area(i)); });
    return areas;
}

}  // namespace vmap
