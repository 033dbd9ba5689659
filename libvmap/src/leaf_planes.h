// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which planes are one: leaves of one wall get the same plane, to the last bit.
#pragma once

#include <vmap/leaf_visibility.h>

#include <Imath/ImathVec.h>

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace vmap {

/// Planes in the order in which they came up.
class PlaneFinder {
public:
    /// - eps: half the thickness of what counts as lying in a plane, in the unit of the places
    explicit PlaneFinder(float eps) : eps_(eps) {}

    /// The plane of a flat leaf: one that came up before and differs by rounding only, else a new one.
    std::uint32_t shared_plane(const Imath::V3f& centroid, const Imath::V3f& normal);

    /// A plane that no other leaf shares.
    std::uint32_t own_plane(const Imath::V3f& centroid, const Imath::V3f& normal, float slab);

    [[nodiscard]] std::vector<LeafPlane> take() { return std::move(planes_); }

private:
    std::vector<LeafPlane> planes_;
    std::unordered_multimap<std::uint64_t, std::uint32_t> by_key_;
    float eps_;
};

}  // namespace vmap
