// SPDX-License-Identifier: Apache-2.0
#include "curved_groups.h"

#include <vmap/outline.h>

#include <Imath/ImathBox.h>

#include <tbb/task_group.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace vmap {
namespace {

using Imath::V3d;
using Imath::V3f;

class GroupCutter {
public:
    GroupCutter(const PointCloud& cloud, std::size_t most_points, float normal_range)
        : cloud_(cloud), most_points_(most_points), normal_range_(normal_range) {}

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
        const auto reach = static_cast<float>(1.5 * spacing * std::sqrt(static_cast<double>(most_points_)));
        const V3f size = places.size();
        const V3f range = normals.size();
        const int place_axis = static_cast<int>(places.majorAxis());
        const int normal_axis = static_cast<int>(normals.majorAxis());
        const float place_excess = size[place_axis] / reach;
        const float normal_excess = range[normal_axis] / normal_range_;
        const bool small = points.size() <= most_points_ && place_excess <= 2;
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
    std::size_t most_points_;
    float normal_range_;
};

}  // namespace

void cut_into_groups(const PointCloud& cloud, std::span<std::uint32_t> points, std::size_t most_points,
                     float normal_range, std::vector<Piece>& groups) {
    GroupCutter(cloud, most_points, normal_range).cut(points, groups);
}

}  // namespace vmap
