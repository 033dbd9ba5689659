// SPDX-License-Identifier: Apache-2.0
/// \file
/// Indirect light on curved surface: every group knows its irradiance as a function of the normal (the vector
/// irradiance of what its rays met), and neighbouring groups of like normal are blended.
///
/// This work is based on: J. Arvo, "The irradiance Jacobian for partially occluded polyhedral sources", SIGGRAPH 1994
/// (vector irradiance).
#pragma once

#include "surface.h"

#include <Imath/ImathColor.h>

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace vmap {

/// Per channel: irradiance over a unit normal n is field.dot(n).
using VectorIrradiance = std::array<Imath::V3f, 3>;

class CurvedLight {
public:
    /// - fields: one per patch; those of flat patches are not looked at
    /// - known: one per patch: whether its field counts; a group of which nothing is known takes its neighbours' light
    CurvedLight(const Surface& surface, std::vector<VectorIrradiance> fields, const std::vector<bool>& known);

    /// Irradiance at a place of a curved group.
    [[nodiscard]] Imath::C3f at(std::uint32_t group, const Imath::V3f& position, const Imath::V3f& normal) const;

private:
    [[nodiscard]] Imath::C3f value(std::uint32_t group, const Imath::V3f& normal) const;
    [[nodiscard]] std::uint64_t key(const Imath::V3f& p, const Imath::V3i& step) const;

    const Surface* surface_;
    std::vector<VectorIrradiance> fields_;
    float reach_ = 1e-30F;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

}  // namespace vmap
