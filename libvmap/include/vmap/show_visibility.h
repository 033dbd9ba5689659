// SPDX-License-Identifier: Apache-2.0
/// \file
/// Visibility as one value per point, to be painted: the seed's pictures of what one point sees, and of umbras.
#pragma once

#include <vmap/light_source.h>
#include <vmap/query_vmap.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vmap {

/// 1 for each point that is visible from a point, 0 for the others.
///
/// - points: of the query's cloud
[[nodiscard]] std::vector<float> visibility_from(const VmapQuery& query, std::size_t points, std::uint32_t from);

/// The lights of a scene: those without a surface, then one for each group of points that emit.
struct SceneLights {
    std::vector<LightSource> sources;
    std::vector<std::vector<std::uint32_t>> surfaces;  ///< points that emit, by material when the cloud knows it

    [[nodiscard]] std::size_t size() const { return sources.size() + surfaces.size(); }
};

[[nodiscard]] SceneLights scene_lights(const PointCloud& cloud, std::span<const LightSource> sources);

/// What light reaches a point of light `light` of the scene, counted through sources and surfaces.
[[nodiscard]] PairStatus light_status(const VmapQuery& query, std::uint32_t x, const SceneLights& lights,
                                      std::size_t light, QueryCost* cost = nullptr);

/// Share of the lights that reach each point, in [0, 1]: 0 in the umbra of all, a half for a penumbra; 1 without
/// lights.
[[nodiscard]] std::vector<float> umbra_picture(const VmapQuery& query, std::size_t points, const SceneLights& lights);

}  // namespace vmap
