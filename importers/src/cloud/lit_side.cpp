// SPDX-License-Identifier: GPL-3.0-or-later
#include "lit_side.h"

#include <Imath/ImathBox.h>

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace vmap {
namespace {

using Imath::V3d;
using Imath::V3f;

/// Share of all directions from a place that meet the surface, each sheet counted by the side it shows: 1 inside a
/// closed surface whose normals face outward, 0 outside.
double winding_number(std::span<const V3f> positions, std::span<const V3f> normals, std::span<const float> areas,
                      const V3d& place) {
    double sum = 0;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const V3d step = V3d(positions[i]) - place;
        const auto area = static_cast<double>(areas[i]);
        // A disc that is nearer than its own size covers no more than half of the directions.
        const double squared = std::max(step.length2(), area / (2 * std::numbers::pi));
        sum += area * step.dot(V3d(normals[i])) / (squared * std::sqrt(squared));
    }
    return sum / (4 * std::numbers::pi);
}

V3d turned_about_y(const V3f& position, double angle) {
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const V3d p(position);
    return {c * p.x - s * p.z, p.y, s * p.x + c * p.z};
}

/// Some of the points, turned about the vertical so that the box around them is smallest.
std::vector<V3d> in_tightest_box(std::span<const V3f> positions, Imath::Box3d& tightest) {
    constexpr std::size_t enough = 20'000;
    constexpr int angles = 18;
    const std::size_t step = positions.size() / enough + 1;
    std::vector<V3d> best;
    double least_volume = std::numeric_limits<double>::infinity();
    for (int k = 0; k < angles; ++k) {
        std::vector<V3d> turned;
        Imath::Box3d box;
        for (std::size_t i = 0; i < positions.size(); i += step) {
            turned.push_back(turned_about_y(positions[i], std::numbers::pi / 2 * k / angles));
            box.extendBy(turned.back());
        }
        const V3d size = box.size();
        const double volume = size.x * size.y * size.z;
        if (volume >= least_volume) continue;
        least_volume = volume;
        best = std::move(turned);
        tightest = box;
    }
    return best;
}

/// Which parts of the six sides of a box have points close by, and how many points are far from all sides.
class BoxCover {
public:
    explicit BoxCover(const Imath::Box3d& box) : box_(box), size_(box.size()) {}

    void add(const V3d& point) {
        ++points_;
        bool inside = true;
        for (int axis = 0; axis < 3; ++axis) {
            const double place = share(point, axis);
            if (place < close) mark(2 * axis, point, axis);
            if (place > 1 - close) mark(2 * axis + 1, point, axis);
            inside = inside && place > deep && place < 1 - deep;
        }
        inside_ += inside ? 1 : 0;
    }

    [[nodiscard]] std::ptrdiff_t covered_sides() const {
        return std::count_if(marks_.begin(), marks_.end(),
                             [](const auto& marks) { return 2 * marks.count() >= marks.size(); });
    }
    [[nodiscard]] double inside_share() const { return static_cast<double>(inside_) / static_cast<double>(points_); }

private:
    static constexpr double close = 0.1;  ///< to a side, as a share of the box's size across it
    static constexpr double deep = 0.15;  ///< far from a side
    static constexpr std::size_t cells = 12;

    [[nodiscard]] double share(const V3d& point, int axis) const {
        return size_[axis] > 0 ? (point[axis] - box_.min[axis]) / size_[axis] : 0.5;
    }
    [[nodiscard]] std::size_t cell(const V3d& point, int axis) const {
        return std::min(static_cast<std::size_t>(share(point, axis) * cells), cells - 1);
    }
    void mark(int side, const V3d& point, int axis) {
        marks_[static_cast<std::size_t>(side)].set(cell(point, (axis + 1) % 3) * cells + cell(point, (axis + 2) % 3));
    }

    Imath::Box3d box_;
    V3d size_;
    std::array<std::bitset<cells * cells>, 6> marks_;
    std::size_t points_ = 0;
    std::size_t inside_ = 0;
};

}  // namespace

bool encloses_light(std::span<const V3f> positions, std::span<const V3f> normals, std::span<const float> areas,
                    std::span<const LightSource> lights) {
    return std::any_of(lights.begin(), lights.end(), [&](const LightSource& light) {
        return light.kind != LightKind::sun && winding_number(positions, normals, areas, light.position) > 0.5;
    });
}

bool looks_like_a_room(std::span<const V3f> positions) {
    constexpr std::ptrdiff_t most_walls = 4;
    constexpr double furnished = 0.03;
    Imath::Box3d box;
    const std::vector<V3d> points = in_tightest_box(positions, box);
    BoxCover cover(box);
    for (const V3d& point : points) cover.add(point);
    return cover.covered_sides() >= most_walls && cover.inside_share() >= furnished;
}

}  // namespace vmap
