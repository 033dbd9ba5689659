// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "frame.h"

namespace vmap::picture {
namespace {

using Imath::V2f;
using Imath::V3f;

/// Share of the lift below which a polygon counts as lying in the plane, not above it.
constexpr float in_plane = 0.05F;

}  // namespace

void Contacts::start(const V3f& position, const V3f& normal, float lift) {
    position_ = position;
    normal_ = normal;
    u_ = any_perpendicular(normal);
    v_ = normal.cross(u_);
    lift_ = lift;
    walls_.clear();
    covers_.clear();
    vertices_.clear();
}

void Contacts::add(std::span<const V3f> polygon) {
    const std::size_t first = vertices_.size();
    float lowest = 0;
    float highest = 0;
    std::array<V2f, 2> cut;
    std::size_t cuts = 0;
    V3f previous = polygon.back() - position_;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const V3f vertex = polygon[i] - position_;
        const float height = vertex.dot(normal_);
        const float before = previous.dot(normal_);
        lowest = i == 0 ? height : std::min(lowest, height);
        highest = i == 0 ? height : std::max(highest, height);
        if ((height > lift_) != (before > lift_) && cuts < 2)
            cut.at(cuts++) = across(previous + (vertex - previous) * ((lift_ - before) / (height - before)));
        vertices_.push_back(across(vertex));
        previous = vertex;
    }
    if (cuts == 2) walls_.push_back({cut[0], cut[1]});

    // The polygon's own plane as a height over ours; one that stands upright covers nothing.
    const V3f own = (polygon[1] - polygon[0]).cross(polygon[2] - polygon[0]);
    const float upright = own.dot(normal_);
    const bool low_cover = highest > in_plane * lift_ && lowest < lift_ && std::abs(upright) > 0.05F * own.length();
    if (!low_cover) {
        vertices_.resize(first);
        return;
    }
    const Cover cover{first,
                      polygon.size(),
                      {-own.dot(u_) / upright, -own.dot(v_) / upright, own.dot(polygon[0] - position_) / upright}};
    if (covers(cover, V2f(0, 0)))
        vertices_.resize(first);  // the place lies under it, and so may its neighbours
    else
        covers_.push_back(cover);
}

bool Contacts::covers(const Cover& cover, const V2f& place) const {
    const float height = cover.plane.x * place.x + cover.plane.y * place.y + cover.plane.z;
    if (!(height > in_plane * lift_) || height > lift_) return false;
    bool left = false;
    bool right = false;
    V2f previous = vertices_[cover.first + cover.count - 1];
    for (std::size_t i = cover.first; i < cover.first + cover.count; ++i) {
        const V2f& vertex = vertices_[i];
        const float side = (vertex - previous).cross(place - previous);
        left = left || side > 0;
        right = right || side < 0;
        previous = vertex;
    }
    return left != right;
}

bool Contacts::separates(const V3f& offset) const {
    const V2f place = across(offset);
    for (const Wall& wall : walls_) {
        const V2f along = wall.to - wall.from;
        const bool way_cuts_wall = (place.cross(wall.from) > 0) != (place.cross(wall.to) > 0);
        const bool wall_cuts_way = (along.cross(-wall.from) > 0) != (along.cross(place - wall.from) > 0);
        if (way_cuts_wall && wall_cuts_way) return true;
    }
    return std::any_of(covers_.begin(), covers_.end(), [&](const Cover& cover) { return covers(cover, place); });
}

}  // namespace vmap::picture
