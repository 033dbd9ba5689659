// SPDX-License-Identifier: Apache-2.0
#include <vmap/patch_shaft.h>
#include <vmap/polygon_set.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vmap {
namespace {

using Imath::V3d;

/// Each cut adds one vertex at most.
constexpr std::size_t most_vertices = max_polygon_vertices + 10;

struct Contour {
    std::array<V3d, most_vertices> vertices;
    std::size_t count = 0;
};

}  // namespace

std::array<V3d, 8> FramedBox::corners() const {
    std::array<V3d, 8> result;
    for (std::size_t i = 0; i < result.size(); ++i)
        result[i] = center + axes[0] * ((i & 1) != 0 ? half.x : -half.x) + axes[1] * ((i & 2) != 0 ? half.y : -half.y) +
                    axes[2] * ((i & 4) != 0 ? half.z : -half.z);
    return result;
}

PatchShaft::PatchShaft(const FramedBox& a, const FramedBox& b, double growth) {
    add_sides(a, b, growth);
    add_sides(b, a, growth);
}

/// The bottom of a box, and through each edge of its bottom the plane that just leaves the other box inside.
void PatchShaft::add_sides(const FramedBox& base, const FramedBox& other, double growth) {
    const V3d half = base.half - V3d(growth);
    half_spaces_[count_++] = {-base.axes[2], half.z - base.axes[2].dot(base.center), true};
    FramedBox joined = other;
    joined.half -= V3d(growth);
    std::array<V3d, 8> seen = joined.corners();
    for (V3d& corner : seen) corner = base.coordinates(corner);
    for (int axis = 0; axis < 2; ++axis)
        for (const double side : {-1.0, 1.0}) {
            double slope = std::numeric_limits<double>::lowest();
            for (const V3d& corner : seen)
                slope = std::max(slope, (side * corner[axis] - half[axis]) / (corner.z + half.z));
            const double length = std::sqrt(1 + slope * slope);
            const V3d normal = (base.axes[static_cast<std::size_t>(axis)] * side - base.axes[2] * slope) / length;
            const double offset = (half[axis] + std::abs(slope) * half.z) / length;
            half_spaces_[count_++] = {normal, offset + normal.dot(base.center), false};
        }
}

bool PatchShaft::is_entered(std::span<const V3d> polygon, double slack) const {
    Contour contour;
    contour.count = polygon.size();
    std::ranges::copy(polygon, contour.vertices.begin());
    for (const HalfSpace& half : half_spaces_) {
        Contour inside;
        const double limit = half.is_end ? half.offset : half.offset + slack;
        const auto excess = [&](const V3d& v) { return half.normal.dot(v) - limit; };
        V3d previous = contour.vertices[contour.count - 1];
        double previous_excess = excess(previous);
        for (std::size_t i = 0; i < contour.count; ++i) {
            const V3d& current = contour.vertices[i];
            const double current_excess = excess(current);
            if ((current_excess < 0) != (previous_excess < 0)) {
                const double t = previous_excess / (previous_excess - current_excess);
                inside.vertices[inside.count++] = previous + (current - previous) * t;
            }
            if (current_excess < 0) inside.vertices[inside.count++] = current;
            previous = current;
            previous_excess = current_excess;
        }
        if (inside.count == 0) return false;
        contour = inside;
    }
    return true;
}

}  // namespace vmap
