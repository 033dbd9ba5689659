// SPDX-License-Identifier: Apache-2.0
#include <vmap/light_source.h>

#include <algorithm>
#include <cmath>

namespace vmap {

double spot_falloff(const LightSource& spot, double cos_angle) {
    const double cos_inner = std::cos(spot.inner_cone_angle);
    const double cos_outer = std::cos(spot.outer_cone_angle);
    if (cos_angle <= cos_outer) return 0;
    if (cos_angle >= cos_inner) return 1;
    const double ramp = (cos_angle - cos_outer) / (cos_inner - cos_outer);
    return ramp * ramp;
}

}  // namespace vmap
