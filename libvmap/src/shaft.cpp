// SPDX-License-Identifier: Apache-2.0
#include "shaft.h"

#include <algorithm>
#include <cmath>

namespace vmap {
namespace {

using Imath::Box3f;
using Imath::V2f;
using Imath::V3f;

/// Coordinate `axis` of the corner on the low (0) or high (1) side.
float side_of(const Box3f& box, int axis, int side) {
    return side == 0 ? box.min[axis] : box.max[axis];
}

}  // namespace

Shaft::Shaft(const Box3f& a, const Box3f& b) {
    Box3f both = a;
    both.extendBy(b);
    for (int axis = 0; axis < 3; ++axis) {
        V3f unit(0);
        unit[axis] = 1;
        add(unit, both.max[axis]);
        add(-unit, -both.min[axis]);
    }
    // In each pair of axes the hull of two rectangles joins corners of the same kind.
    for (int x = 0; x < 3; ++x) {
        const int y = (x + 1) % 3;
        for (int corner = 0; corner < 4; ++corner) {
            const int sx = corner & 1;
            const int sy = corner >> 1;
            const V2f from(side_of(a, x, sx), side_of(a, y, sy));
            const V2f to(side_of(b, x, sx), side_of(b, y, sy));
            V2f outwards(from.y - to.y, to.x - from.x);
            const float length = outwards.length();
            if (!(length > 0)) continue;
            outwards /= length;
            const V2f diagonal(sx == 0 ? -1.0F : 1.0F, sy == 0 ? -1.0F : 1.0F);
            if (outwards.dot(diagonal) < 0) outwards = -outwards;
            // A supporting line only if both rectangles lie behind it.
            float farthest = std::numeric_limits<float>::lowest();
            for (const Box3f* box : {&a, &b})
                for (int other = 0; other < 4; ++other)
                    farthest = std::max(farthest,
                                        outwards.dot(V2f(side_of(*box, x, other & 1), side_of(*box, y, other >> 1))));
            const float offset = outwards.dot(from);
            const float rounding = 4e-7F * (std::abs(offset) + both.size().length());
            if (farthest > offset + rounding) continue;
            V3f normal(0);
            normal[x] = outwards.x;
            normal[y] = outwards.y;
            add(normal, offset + rounding);
        }
    }
}

bool Shaft::may_hold(std::span<const V3f> polygon) const {
    return std::none_of(half_spaces_.begin(), half_spaces_.begin() + static_cast<std::ptrdiff_t>(count_),
                        [&](const HalfSpace& half) {
                            return std::all_of(polygon.begin(), polygon.end(),
                                               [&](const V3f& v) { return half.normal.dot(v) > half.offset; });
                        });
}

}  // namespace vmap
