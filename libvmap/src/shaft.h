// SPDX-License-Identifier: Apache-2.0
/// \file
/// The shaft between two boxes: everything that a segment from one to the other can meet lies in it.
///
/// This work is based on: E. Haines, J. Wallace, "Shaft culling for efficient ray-traced radiosity", EGWR 1991.
#pragma once

#include <vmap/polygon_bvh.h>

#include <Imath/ImathBox.h>

#include <array>
#include <cstddef>
#include <span>

namespace vmap {

class Shaft {
public:
    /// Convex hull of the two boxes, as half-spaces.
    Shaft(const Imath::Box3f& a, const Imath::Box3f& b);

    /// All that lies within `margin` of a box.
    [[nodiscard]] static Shaft around(const Imath::Box3f& box, float margin) {
        const Imath::Box3f grown(box.min - Imath::V3f(margin), box.max + Imath::V3f(margin));
        return {grown, grown};
    }

    [[nodiscard]] std::span<const HalfSpace> half_spaces() const { return {half_spaces_.data(), count_}; }

    /// Whether a convex polygon may reach in: false only if it lies wholly outside one of the half-spaces.
    [[nodiscard]] bool may_hold(std::span<const Imath::V3f> polygon) const;

private:
    void add(const Imath::V3f& normal, float offset) { half_spaces_[count_++] = {normal, offset}; }

    std::array<HalfSpace, 18> half_spaces_;
    std::size_t count_ = 0;
};

}  // namespace vmap
