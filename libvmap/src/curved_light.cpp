// SPDX-License-Identifier: Apache-2.0
#include "curved_light.h"

#include "sampling.h"

#include <algorithm>
#include <cmath>

namespace vmap {

using Imath::C3f;
using Imath::V3f;

namespace {

/// Groups blend over so many of their own sizes,
constexpr float blend_reach = 1.5F;
/// and as far as the cosine of their normals is that near to 1.
constexpr float blend_turn = 0.1F;

}  // namespace

CurvedLight::CurvedLight(const Surface& surface, std::vector<VectorIrradiance> fields, const std::vector<bool>& known)
    : surface_(&surface), fields_(std::move(fields)) {
    for (const Patch& patch : surface.set.patches)
        if (!patch.flat) reach_ = std::max(reach_, blend_reach * std::sqrt(patch.area));
    for (std::uint32_t p = 0; p < surface.set.patches.size(); ++p)
        if (!surface.set.patches[p].flat && known[p])
            cells_[key(surface.set.patches[p].center, {0, 0, 0})].push_back(p);
}

C3f CurvedLight::at(std::uint32_t group, const V3f& position, const V3f& normal) const {
    C3f sum(0, 0, 0);
    float total = 0;
    const float reach = blend_reach * std::sqrt(surface_->set.patches[group].area);
    for (int dx = -1; dx <= 1; ++dx)
        for (int dy = -1; dy <= 1; ++dy)
            for (int dz = -1; dz <= 1; ++dz) {
                const auto cell = cells_.find(key(position, {dx, dy, dz}));
                if (cell == cells_.end()) continue;
                for (const std::uint32_t p : cell->second) {
                    const Patch& patch = surface_->set.patches[p];
                    const float near = 1 - (patch.center - position).length2() / (reach * reach);
                    const float alike = near - (1 - patch.normal.dot(normal)) / blend_turn;
                    if (alike <= 0) continue;
                    sum += value(p, normal) * (alike * alike);
                    total += alike * alike;
                }
            }
    return total > 0 ? sum / total : value(group, normal);
}

C3f CurvedLight::value(std::uint32_t group, const V3f& normal) const {
    // Over a normal that turns away from the group's the hemisphere that was looked at sinks on one side, and one that
    // was not rises on the other. Light from all around does not change by that, so only what lies along the surface
    // turns with the normal.
    const V3f& own = surface_->set.patches[group].normal;
    const float lost = 1 - own.dot(normal);
    C3f light;
    for (int c = 0; c < 3; ++c) {
        const V3f& field = fields_[group].at(static_cast<std::size_t>(c));
        light[c] = std::max(field.dot(normal) + field.dot(own) * lost, 0.0F);
    }
    return light;
}

std::uint64_t CurvedLight::key(const V3f& p, const Imath::V3i& step) const {
    std::uint64_t hash = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const auto cell = static_cast<std::int64_t>(std::floor(p[axis] / reach_)) + step[axis];
        hash = hash64(hash ^ static_cast<std::uint64_t>(cell));
    }
    return hash;
}

}  // namespace vmap
