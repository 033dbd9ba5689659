// SPDX-License-Identifier: Apache-2.0
/// \file
/// Light that comes by way of other surfaces, any number of times: gathered by first-hit rays at few receivers, each
/// ray remembering the piece of surface it met, so that every further bounce is a sparse sum.
///
/// This work is based on:
///   G. J. Ward, F. M. Rubinstein, R. D. Clear, "A ray tracing solution for diffuse interreflection", SIGGRAPH 1988;
///   Y. Saad, M. H. Schultz, "GMRES", SIAM J. Sci. Stat. Comput. 1986 (the solution of the many bounces).
#pragma once

#include "surface.h"

#include <vmap/progress.h>
#include <vmap/sky.h>

#include <Imath/ImathColor.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vmap {

struct IndirectConfig {
    double tolerance = 0.01;
    std::uint64_t seed = 1;
    bool gather_emission = false;  ///< emission is seen by the rays: the direct light leaves it out
    Sky sky;                       ///< what rays see that meet no surface
};

struct IndirectResult {
    std::vector<Imath::C3f> irradiance;  ///< at every point, in the cloud's order
    std::size_t receivers = 0;
    std::size_t rays = 0;
    double noise_mean = 0;  ///< W/m^2: mean standard error at the receivers, from two half sets of the rays
    double noise_p95 = 0;
    bool converged = true;
};

/// - direct: irradiance at every point straight from the lights
[[nodiscard]] IndirectResult indirect_light(const Surface& surface, const std::vector<Imath::C3f>& direct,
                                            const IndirectConfig& config, const ProgressCallback& progress);

}  // namespace vmap
