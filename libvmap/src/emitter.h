// SPDX-License-Identifier: Apache-2.0
/// \file
/// The emissive surface as flat polygons that each send out one radiance.
#pragma once

#include "surface.h"

#include <Imath/ImathColor.h>
#include <Imath/ImathVec.h>

#include <cstdint>
#include <vector>

namespace vmap {

/// A flat emissive polygon.
struct Emitter {
    std::vector<Imath::V3d> vertices;  ///< relative to the cloud's origin, counter-clockwise seen from the lit side
    Imath::V3f normal{0, 0, 1};
    Imath::Box3f bounds;
    Imath::C3f radiance{0, 0, 0};  ///< Le, W/(m^2 sr)
    float area = 0;
    float lift = 0;  ///< neighbours of a curved emitter reach so far over its plane, and hide nothing of it
    float turn = 0;  ///< sine of how far normals of a curved emitter are from its own
    std::uint32_t patch = 0;
};

/// Cosine at an emitter whose normals lie up to `turn` around its own: where it turns away it fades, as the part of it
/// that still faces the place gets smaller.
[[nodiscard]] inline float emitted_cosine(float cosine, float turn) {
    if (cosine >= turn) return cosine;
    return cosine <= -turn ? 0 : (cosine + turn) * (cosine + turn) / (4 * turn);
}

/// The emissive patches as polygons. Patches whose emission varies give one polygon a tile.
[[nodiscard]] std::vector<Emitter> find_emitters(const Surface& surface);

/// A place on an emitter; places of evenly spread samples are evenly spread over its area.
[[nodiscard]] Imath::V3d place_on(const Emitter& emitter, const Imath::V2d& sample);

}  // namespace vmap
