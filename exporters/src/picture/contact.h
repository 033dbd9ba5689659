// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Where surfaces stand on each other, light changes from one point to the next: the floor under a box is dark, beside
/// it is bright. Contacts tell which points of a plane are cut off from a place on it.
#pragma once

#include <Imath/ImathVec.h>

#include <span>
#include <vector>

namespace vmap::picture {

class Contacts {
public:
    /// A place with nothing around it yet.
    /// - lift: height over the plane at which the way from the place to a point is looked at, world units
    void start(const Imath::V3f& position, const Imath::V3f& normal, float lift);

    /// Adds a flat convex polygon that may stand on the plane or lie close above it.
    void add(std::span<const Imath::V3f> polygon);

    [[nodiscard]] bool empty() const { return walls_.empty() && covers_.empty(); }

    /// Whether the way up from the place, across at the lift, and down to a point of its plane is blocked.
    /// - offset: of the point from the place
    [[nodiscard]] bool separates(const Imath::V3f& offset) const;

private:
    /// A cut through a polygon at the height of the lift.
    struct Wall {
        Imath::V2f from;
        Imath::V2f to;
    };
    /// A polygon seen from above that comes lower than the lift.
    struct Cover {
        std::size_t first = 0;  ///< of its vertices
        std::size_t count = 0;
        Imath::V3f plane{0, 0, 0};  ///< height = plane.x * x + plane.y * y + plane.z
    };

    [[nodiscard]] Imath::V2f across(const Imath::V3f& offset) const { return {offset.dot(u_), offset.dot(v_)}; }
    [[nodiscard]] bool covers(const Cover& cover, const Imath::V2f& place) const;

    Imath::V3f position_{0, 0, 0};
    Imath::V3f normal_{0, 0, 1};
    Imath::V3f u_{1, 0, 0};
    Imath::V3f v_{0, 1, 0};
    float lift_ = 0;
    std::vector<Wall> walls_;
    std::vector<Cover> covers_;
    std::vector<Imath::V2f> vertices_;
};

}  // namespace vmap::picture
