// SPDX-License-Identifier: Apache-2.0
#include <vmap/patch_shaft.h>
#include <vmap/polygon_set.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
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

void FramedBox::find_corners() {
    corner_count = half.z > 0 ? 8 : 4;
    for (std::size_t i = 0; i < corner_count; ++i)
        all_corners[i] = center + axes[0] * ((i & 1) != 0 ? half.x : -half.x) +
                         axes[1] * ((i & 2) != 0 ? half.y : -half.y) + axes[2] * ((i & 4) != 0 ? half.z : -half.z);
}

PatchShaft::PatchShaft(const FramedBox& a, const FramedBox& b) {
    add_sides(a, b);
    add_sides(b, a);
}

/// The bottom of a box, and through each edge of its bottom the plane that just leaves the other box inside.
void PatchShaft::add_sides(const FramedBox& base, const FramedBox& other) {
    half_spaces_[count_++] = {-base.axes[2], base.half.z - base.axes[2].dot(base.center), true};
    std::array<double, 4> slopes;  // on the low and high side of both axes
    slopes.fill(std::numeric_limits<double>::lowest());
    for (const V3d& corner : other.corners()) {
        const V3d at = base.coordinates(corner);
        const double per_height = 1 / (at.z + base.half.z);
        slopes[0] = std::max(slopes[0], (-at.x - base.half.x) * per_height);
        slopes[1] = std::max(slopes[1], (at.x - base.half.x) * per_height);
        slopes[2] = std::max(slopes[2], (-at.y - base.half.y) * per_height);
        slopes[3] = std::max(slopes[3], (at.y - base.half.y) * per_height);
    }
    for (std::size_t i = 0; i < slopes.size(); ++i) {
        const double side = i % 2 == 0 ? -1 : 1;
        const double length = std::sqrt(1 + slopes[i] * slopes[i]);
        const V3d normal = (base.axes[i / 2] * side - base.axes[2] * slopes[i]) / length;
        const double offset = (base.half[static_cast<int>(i / 2)] + std::abs(slopes[i]) * base.half.z) / length;
        half_spaces_[count_++] = {normal, offset + normal.dot(base.center), false};
    }
}

bool PatchShaft::is_entered(std::span<const V3d> polygon, double slack) const {
    // Most polygons lie outside of one half-space, or have a vertex inside of all.
    std::uint32_t inside_all = ~std::uint32_t{0};
    for (const HalfSpace& half : half_spaces_) {
        std::uint32_t inside = 0;
        for (std::size_t i = 0; i < polygon.size(); ++i) inside |= (half.excess(polygon[i], slack) < 0 ? 1U : 0U) << i;
        if (inside == 0) return false;
        inside_all &= inside;
    }
    if (inside_all != 0) return true;

    Contour contour;
    contour.count = polygon.size();
    std::ranges::copy(polygon, contour.vertices.begin());
    for (const HalfSpace& half : half_spaces_) {
        Contour inside;
        V3d previous = contour.vertices[contour.count - 1];
        double previous_excess = half.excess(previous, slack);
        for (std::size_t i = 0; i < contour.count; ++i) {
            const V3d& current = contour.vertices[i];
            const double current_excess = half.excess(current, slack);
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
