// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Irradiance by path tracing over the triangles of a scene: unbiased, and each value with its standard error.
///
/// This work is based on:
///   J. T. Kajiya, "The rendering equation", SIGGRAPH 1986;
///   E. Veach, L. J. Guibas, "Optimally combining sampling techniques for Monte Carlo rendering", SIGGRAPH 1995;
///   A. B. Owen, "Randomly permuted (t,m,s)-nets and (t,s)-sequences", 1995 (the error from independent scramblings).
#pragma once

#include <vmap/progress.h>
#include <vmap/scene.h>

#include <Imath/ImathColor.h>
#include <Imath/ImathVec.h>

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace vmap::reference {

/// Where irradiance is wanted.
struct ReferencePoint {
    static constexpr std::uint32_t no_face = std::numeric_limits<std::uint32_t>::max();

    Imath::V3d position{0, 0, 0};  ///< world, on the surface
    Imath::V3d normal{0, 0, 1};    ///< unit, of the hemisphere that light comes from
    std::uint32_t face = no_face;  ///< triangle that the point lies on, numbered as by first_faces; takes out what
                                   ///< rounding has moved the point away from its plane
};

struct ReferenceConfig {
    static constexpr int all_bounces = 10'000;

    std::size_t samples = 1024;     ///< paths per point, rounded up to a multiple of the number of replicates
    int max_bounces = all_bounces;  ///< reflections of light before it arrives; 0 is direct light only
    Imath::C3f sky{0, 0, 0};        ///< radiance from where no surface is
    std::uint64_t seed = 1;
};

/// Irradiance at one point, W/m^2, linear Rec.709.
struct ReferenceValue {
    Imath::C3f irradiance{0, 0, 0};
    Imath::C3f standard_error{0, 0, 0};  ///< of each channel
    float mean_standard_error = 0;       ///< of the mean of the channels
};

/// Light of emissive surfaces, lights and sky, direct and reflected by diffuse surfaces.
///
/// A single-sided surface emits and reflects in front, its back is black; a double-sided one does both on either side;
/// both block. Surface that an alpha mask cuts away is not there. Where several sheets lie in one place light meets the
/// one that emits towards it first, then one that faces it. A point is not covered by a sheet that lies in its place.
/// Albedo above 1 counts as 1; paths end after 10 000 bounces.
///
/// - scene: indices in range, as the importers deliver it
/// - returns one value per point, the same for the same seed at any number of threads
[[nodiscard]] std::vector<ReferenceValue> trace_irradiance(const Scene& scene, std::span<const ReferencePoint> points,
                                                           const ReferenceConfig& config = {},
                                                           const ProgressCallback& progress = {});

}  // namespace vmap::reference
