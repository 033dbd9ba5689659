// SPDX-License-Identifier: Apache-2.0
/// \file
/// Irradiance straight from the lights. A tile of points that sees all of a light gets the closed form and no ray, one
/// that sees nothing of it gets nothing, and only between the two is visibility worked out point by point.
#pragma once

#include "surface.h"

#include <vmap/light_source.h>
#include <vmap/progress.h>

#include <Imath/ImathColor.h>

#include <cstdint>
#include <span>
#include <vector>

namespace vmap {

/// A flat emissive polygon.
struct Emitter {
    std::vector<Imath::V3d> vertices;  ///< relative to the cloud's origin, counter-clockwise seen from the lit side
    Imath::V3f normal{0, 0, 1};
    Imath::Box3f bounds;
    Imath::C3f radiance{0, 0, 0};  ///< Le, W/(m^2 sr)
    std::uint32_t patch = 0;
};

/// The emissive patches as polygons. Patches whose emission varies give one polygon a tile.
[[nodiscard]] std::vector<Emitter> find_emitters(const Surface& surface);

/// Irradiance at every point of the cloud, in the cloud's order, from emitters and lights; occlusion included.
[[nodiscard]] std::vector<Imath::C3f> direct_light(const Surface& surface, std::span<const Emitter> emitters,
                                                   std::span<const LightSource> lights, std::uint64_t seed,
                                                   const ProgressCallback& progress);

}  // namespace vmap
