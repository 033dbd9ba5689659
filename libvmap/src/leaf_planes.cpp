// SPDX-License-Identifier: Apache-2.0
#include "leaf_planes.h"

#include "sampling.h"

#include <array>
#include <cmath>

namespace vmap {
namespace {

using Imath::V3d;
using Imath::V3f;

constexpr double normal_tolerance = 4e-6;  ///< per component; averages of equal normals differ by a tenth of it
constexpr double key_step = 1e-3;          ///< far above the tolerances, so that few values lie near a border

std::uint64_t mix(std::uint64_t key, double value) {
    return hash64(key ^ static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(value / key_step))));
}

}  // namespace

std::uint32_t PlaneFinder::own_plane(const V3f& centroid, const V3f& normal, float slab) {
    const V3d n(normal);
    const V3d u = n.cross(std::abs(n.x) < 0.6 ? V3d(1, 0, 0) : V3d(0, 1, 0)).normalized();
    LeafPlane& plane = planes_.emplace_back();
    plane.normal = normal;
    plane.u = V3f(u);
    plane.v = V3f(n.cross(u));
    plane.offset = static_cast<float>(n.dot(V3d(centroid)));
    plane.slab = slab;
    return static_cast<std::uint32_t>(planes_.size() - 1);
}

std::uint32_t PlaneFinder::shared_plane(const V3f& centroid, const V3f& normal) {
    const double offset = V3d(normal).dot(V3d(centroid));
    const double offset_tolerance = 0.125 * static_cast<double>(eps_);
    const std::array<double, 4> values{static_cast<double>(normal.x), static_cast<double>(normal.y),
                                       static_cast<double>(normal.z), offset};
    // A value near the border of its step may have its twin on the other side: both sides are looked up.
    for (unsigned side = 0; side < 16; ++side) {
        std::uint64_t key = 0;
        bool is_repetition = false;
        for (std::size_t i = 0; i < values.size(); ++i) {
            const double tolerance = i < 3 ? normal_tolerance : offset_tolerance;
            const bool upper = (side >> i & 1) != 0;
            is_repetition |= upper && std::floor((values[i] + tolerance) / key_step) ==
                                          std::floor((values[i] - tolerance) / key_step);
            key = mix(key, values[i] + (upper ? tolerance : -tolerance));
        }
        if (is_repetition) continue;
        const auto [begin, end] = by_key_.equal_range(key);
        for (auto at = begin; at != end; ++at) {
            const LeafPlane& plane = planes_[at->second];
            const V3d turn = V3d(plane.normal) - V3d(normal);
            const double height = V3d(plane.normal).dot(V3d(centroid)) - static_cast<double>(plane.offset);
            if (std::abs(turn.x) <= normal_tolerance && std::abs(turn.y) <= normal_tolerance &&
                std::abs(turn.z) <= normal_tolerance && std::abs(height) <= offset_tolerance)
                return at->second;
        }
    }
    const std::uint32_t plane = own_plane(centroid, normal, eps_);
    std::uint64_t key = 0;
    for (const double value : values) key = mix(key, value);
    by_key_.emplace(key, plane);
    return plane;
}

}  // namespace vmap
