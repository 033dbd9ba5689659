// SPDX-License-Identifier: Apache-2.0
/// \file
/// Diffuse global illumination of a point cloud: the library's main job in one call.
#pragma once

#include <vmap/light_source.h>
#include <vmap/point_cloud.h>
#include <vmap/progress.h>
#include <vmap/sky.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace vmap {

struct LightConfig {
    double tolerance = 0.01;  ///< mean |dE| / mean E asked for, in (0, 1]
    std::uint64_t seed = 1;   ///< of the quasi-random rays
    Sky sky;                  ///< what is seen where no surface is; none by default
};

/// What the computation made, spent and left open.
struct LightReport {
    std::size_t nodes = 0;
    std::size_t leaves = 0;
    std::size_t patches = 0;
    std::size_t receivers = 0;  ///< places where indirect light was gathered
    std::size_t rays = 0;
    double tree_seconds = 0;
    double direct_seconds = 0;
    double indirect_seconds = 0;
    double error_mean = 0;  ///< estimated mean |dE| / mean E
    double error_p95 = 0;   ///< estimated 95th percentile of |dE| / mean E
    bool converged = true;  ///< false when the light between the patches did not settle
    std::vector<std::string> warnings;
};

struct LightResult {
    std::vector<Imath::C3f> irradiance;  ///< E at each point, W/m^2, linear Rec.709, over the point's normal
    LightReport report;
};

/// Irradiance at every point: direct light of the sources, of the points that emit and of the sky, and its reflections
/// between the points, any number of times. The result is the same bit for bit at any number of threads.
///
/// - cloud: finite, normals of unit length, areas positive
/// - throws UsageError for a tolerance outside (0, 1], UnsupportedInput when nothing emits light or when a closed scene
///   reflects everything (no finite answer)
[[nodiscard]] LightResult compute_light(const PointCloud& cloud, std::span<const LightSource> lights,
                                        const LightConfig& config = {}, const ProgressCallback& progress = {});

}  // namespace vmap
