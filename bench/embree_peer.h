// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Embree on the same scene: on a disc for each point, or on the triangles that the points were sampled from.
#pragma once

#include "rooms.h"

#include <embree3/rtcore.h>

#include <Imath/ImathVec.h>

#include <limits>

namespace vmap::bench {

/// Positions are relative to the origin of the room's cloud. One query at a time, as single rays.
class EmbreePeer {
public:
    enum class Of {
        discs,      ///< radius: half the diagonal of a square of the mean spacing
        triangles,  ///< as rendering does it
        truth       ///< triangles, robust: no ray passes between two of them
    };

    EmbreePeer(const Room& room, Of what);
    ~EmbreePeer();
    EmbreePeer(const EmbreePeer&) = delete;
    EmbreePeer& operator=(const EmbreePeer&) = delete;

    /// Whether anything lies between two positions.
    [[nodiscard]] bool is_blocked(const Imath::V3f& from, const Imath::V3f& to) const;

    /// Distance of the first hit in lengths of the direction; infinity for a miss.
    [[nodiscard]] float first_hit(const Imath::V3f& from, const Imath::V3f& direction) const;

private:
    void add_discs(const Room& room) const;
    void add_triangles(const Room& room) const;

    RTCDevice device_;
    RTCScene scene_;
};

}  // namespace vmap::bench
