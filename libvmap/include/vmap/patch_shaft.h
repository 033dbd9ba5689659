// SPDX-License-Identifier: Apache-2.0
/// \file
/// The shaft between two pieces of surface that face each other, as half-spaces: the convex hull of both, exact for
/// flat pieces.
///
/// This work is based on: E. Haines, J. Wallace, "Shaft culling for efficient ray-traced radiosity", EGWR 1991.
#pragma once

#include <Imath/ImathVec.h>

#include <array>
#include <cstddef>
#include <span>

namespace vmap {

/// A box in a frame of its own: center + x * half.x * axes[0] + ..., x, y and z in [-1, 1]. Flat when half.z is 0.
struct FramedBox {
    Imath::V3d center{0, 0, 0};
    std::array<Imath::V3d, 3> axes{Imath::V3d(1, 0, 0), Imath::V3d(0, 1, 0),
                                   Imath::V3d(0, 0, 1)};  ///< unit, orthogonal
    Imath::V3d half{0, 0, 0};
    std::array<Imath::V3d, 8> all_corners;  ///< the first four suffice for a flat box
    std::size_t corner_count = 8;

    /// Fills in the corners.
    void find_corners();
    [[nodiscard]] std::span<const Imath::V3d> corners() const { return std::span(all_corners).first(corner_count); }

    /// Coordinates of a place along the axes, from the centre.
    [[nodiscard]] Imath::V3d coordinates(const Imath::V3d& place) const {
        const Imath::V3d from_center = place - center;
        return {axes[0].dot(from_center), axes[1].dot(from_center), axes[2].dot(from_center)};
    }
};

class PatchShaft {
public:
    /// - a, b: each lies wholly above the other, along the third axis of the other's frame
    PatchShaft(const FramedBox& a, const FramedBox& b);

    /// Whether a convex polygon reaches in between the two, when the shaft's sides are moved outwards by `slack`.
    [[nodiscard]] bool is_entered(std::span<const Imath::V3d> polygon, double slack) const;

private:
    struct HalfSpace {
        Imath::V3d normal;  ///< unit; inside is normal.dot(x) <= offset
        double offset;
        bool is_end;

        [[nodiscard]] double excess(const Imath::V3d& place, double slack) const {
            return normal.dot(place) - (is_end ? offset : offset + slack);
        }
    };

    void add_sides(const FramedBox& base, const FramedBox& other);

    std::array<HalfSpace, 10> half_spaces_;
    std::size_t count_ = 0;
};

}  // namespace vmap
