// SPDX-License-Identifier: GPL-3.0-or-later
#include "polygon_soup.h"

#include <Imath/ImathBox.h>

#include <algorithm>
#include <cmath>

namespace vmap {
namespace {

using Imath::V3d;
using Imath::V3f;

/// Floats have 24 bits: about the origin a surface of this many times its own extent still has 20 bits for its shape.
constexpr double farthest_per_extent = 16;

double largest_component(const V3d& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// Few digits, so that adding it changes nothing but the exponent of what is added to.
double rounded(double value, double extent) {
    const double step = extent > 0 ? std::exp2(std::floor(std::log2(extent))) : 1;
    return std::round(value / step) * step;
}

}  // namespace

FramedPositions frame_positions(const std::vector<V3d>& positions) {
    Imath::Box3d box;
    bool exact = true;
    for (const V3d& position : positions) {
        box.extendBy(position);
        exact = exact && V3d(V3f(position)) == position;
    }

    FramedPositions framed;
    if (!exact && !box.isEmpty()) {
        const double extent = largest_component(box.max - box.min);
        const double farthest = std::max(largest_component(box.min), largest_component(box.max));
        const V3d middle = (box.min + box.max) * 0.5;
        if (farthest > farthest_per_extent * extent)
            framed.origin = {rounded(middle.x, extent), rounded(middle.y, extent), rounded(middle.z, extent)};
    }
    framed.offsets.reserve(positions.size());
    for (const V3d& position : positions) framed.offsets.emplace_back(position - framed.origin);
    return framed;
}

}  // namespace vmap
