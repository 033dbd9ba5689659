// SPDX-License-Identifier: Apache-2.0
/// \file
/// The straight walk from one cell of a uniform grid to another: one cell per step along the longest axis.
///
/// This work is based on: J. E. Bresenham, "Algorithm for computer control of a digital plotter", IBM Systems Journal
/// 1965, in closed form: step i of `length` lies round(i * d / length) cells away along each axis.
#pragma once

#include <Imath/ImathVec.h>

#include <algorithm>
#include <cstdlib>
#include <tuple>
#include <utility>

namespace vmap {

class CellWalk {
public:
    /// The walk is the same in both directions: it starts at the smaller end.
    CellWalk(Imath::V3i a, Imath::V3i b) {
        if (std::tie(b.x, b.y, b.z) < std::tie(a.x, a.y, a.z)) std::swap(a, b);
        from_ = a;
        for (int axis = 0; axis < 3; ++axis) {
            steps_[axis] = std::abs(b[axis] - a[axis]);
            sign_[axis] = b[axis] < a[axis] ? -1 : 1;
            if (steps_[axis] > steps_[longest_]) longest_ = axis;
        }
        length_ = steps_[longest_];
    }

    /// Cells on the walk, less one.
    [[nodiscard]] int length() const { return length_; }

    /// - step: 0 to length()
    [[nodiscard]] Imath::V3i cell(int step) const {
        Imath::V3i at = from_;
        for (int axis = 0; axis < 3; ++axis) at[axis] += sign_[axis] * offset(step, axis);
        return at;
    }

    [[nodiscard]] bool visits(const Imath::V3i& k) const {
        const int step = sign_[longest_] * (k[longest_] - from_[longest_]);
        return step >= 0 && step <= length_ && cell(step) == k;
    }

private:
    [[nodiscard]] int offset(int step, int axis) const {
        return length_ == 0 ? 0 : (2 * step * steps_[axis] + length_) / (2 * length_);
    }

    Imath::V3i from_{0, 0, 0};
    Imath::V3i steps_{0, 0, 0};
    Imath::V3i sign_{1, 1, 1};
    int longest_ = 0;
    int length_ = 0;
};

}  // namespace vmap
