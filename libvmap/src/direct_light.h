// SPDX-License-Identifier: Apache-2.0
/// \file
/// Irradiance straight from the lights. A tile of points that sees all of a light gets the closed form and no ray, one
/// that sees nothing of it gets nothing, and only between the two is visibility worked out point by point. Many lights
/// close together count as one from afar.
#pragma once

#include "emitter.h"
#include "surface.h"

#include <vmap/light_source.h>
#include <vmap/progress.h>

#include <Imath/ImathColor.h>

#include <cstdint>
#include <span>
#include <vector>

namespace vmap {

/// Irradiance at every point of the cloud, in the cloud's order, from emitters and lights; occlusion included.
///
/// - tolerance: mean |dE| / mean E that the whole computation may have; how far away lights must be to count as one
[[nodiscard]] std::vector<Imath::C3f> direct_light(const Surface& surface, std::span<const Emitter> emitters,
                                                   std::span<const LightSource> sources, double tolerance,
                                                   std::uint64_t seed, const ProgressCallback& progress);

}  // namespace vmap
