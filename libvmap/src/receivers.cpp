// SPDX-License-Identifier: Apache-2.0
#include "receivers.h"

#include "shaft.h"

#include <algorithm>
#include <cmath>

namespace vmap {
namespace {

using Imath::V2f;
using Imath::V2i;
using Imath::V3f;

constexpr int finest_steps = 1 << ReceiverGrid::max_level;

/// The place itself, or the nearest one at least `inset` inside of a convex outline (nearly, at its corners).
V2f pulled_inside(V2f place, const Patch& patch, std::span<const V3f> outline, float inset) {
    for (int round = 0; round < 2; ++round)
        for (std::size_t i = 0; i < outline.size(); ++i) {
            const V2f from = patch.to_plane(outline[i]);
            const V2f along = (patch.to_plane(outline[(i + 1) % outline.size()]) - from).normalized();
            const V2f inwards(-along.y, along.x);
            const float depth = inwards.dot(place - from);
            if (depth < inset) place += inwards * (inset - depth);
        }
    return place;
}

/// Whether a patch stands on the plane of another within the square around a place, or hovers lower than `reach`.
bool stands_on(const Surface& surface, std::uint32_t patch_index, const V2f& low, const V2f& high, float reach) {
    const Patch& patch = surface.set.patches[patch_index];
    const float touch = 4 * surface.gather_offset(patch);
    Imath::Box3f box;
    for (const V2f& q : {low, V2f(high.x, low.y), high, V2f(low.x, high.y)}) {
        box.extendBy(patch.from_plane(q));
        box.extendBy(patch.from_plane(q) + patch.normal * reach);
    }
    std::vector<std::uint32_t> found;
    surface.bvh.polygons_in(Shaft::around(box, touch).half_spaces(), found);
    return std::any_of(found.begin(), found.end(), [&](std::uint32_t other) {
        if (other == patch_index) return false;
        float lowest = std::numeric_limits<float>::max();
        float highest = std::numeric_limits<float>::lowest();
        Imath::Box2f extent;
        for (const V3f& v : surface.set.outlines[other]) {
            const float height = patch.normal.dot(v - patch.center);
            lowest = std::min(lowest, height);
            highest = std::max(highest, height);
            extent.extendBy(patch.to_plane(v));
        }
        return lowest < reach && highest > touch && extent.min.x < high.x && extent.max.x > low.x &&
               extent.min.y < high.y && extent.max.y > low.y;
    });
}

}  // namespace

ReceiverGrid::ReceiverGrid(const Surface& surface, std::uint32_t patch, float coarsest, float finest,
                           std::vector<Receiver>& receivers)
    : surface_(&surface), patch_(patch), finest_(finest) {
    Imath::Box2f box;
    for (const V3f& v : surface.set.outlines[patch]) box.extendBy(surface.set.patches[patch].to_plane(v));
    low_ = box.min;
    for (int axis = 0; axis < 2; ++axis) {
        count_[axis] = std::max(1, static_cast<int>(std::ceil(box.size()[axis] / coarsest)));
        step_[axis] = box.size()[axis] / static_cast<float>(count_[axis] * finest_steps);
    }
    for (int y = 0; y < count_.y; ++y)
        for (int x = 0; x < count_.x; ++x) {
            Cell cell;
            cell.at = {x * finest_steps, y * finest_steps};
            finish(cell, receivers);
            cells_.push_back(cell);
        }
}

V2f ReceiverGrid::place_of(int x, int y) const {
    return low_ + V2f(static_cast<float>(x) * step_.x, static_cast<float>(y) * step_.y);
}

std::uint32_t ReceiverGrid::vertex(int x, int y, const Cell& cell, std::vector<Receiver>& receivers) {
    const std::uint64_t key = key_of(x, y);
    const auto [found, is_new] = vertices_.try_emplace(key);
    Vertex& vertex = found->second;
    vertex.level = std::max(vertex.level, cell.level);
    vertex.contact = vertex.contact || cell.contact;
    if (is_new) {
        vertex.receiver = static_cast<std::uint32_t>(receivers.size());
        order_.push_back(key);
        const Patch& patch = surface_->set.patches[patch_];
        const float inset = 0.1F * std::min(step_.x, step_.y);
        const V2f place = pulled_inside(place_of(x, y), patch, surface_->set.outlines[patch_], inset);
        const int size = steps_of(cell.level);
        const auto set = static_cast<std::uint32_t>((x / size & 3) + 4 * (y / size & 3));
        receivers.push_back({patch.from_plane(place), patch.normal, place, patch_, set});
    }
    return vertex.receiver;
}

void ReceiverGrid::finish(Cell& cell, std::vector<Receiver>& receivers) {
    const int size = steps_of(cell.level);
    // What only runs along the border of the cell does not stand on it.
    const V2f margin = step_ * 0.05F;
    const float reach = 0.5F * static_cast<float>(size) * std::min(step_.x, step_.y);
    cell.contact = stands_on(*surface_, patch_, place_of(cell.at.x, cell.at.y) + margin,
                             place_of(cell.at.x + size, cell.at.y + size) - margin, reach);
    for (int corner = 0; corner < 4; ++corner)
        cell.vertex.at(static_cast<std::size_t>(corner)) =
            vertex(cell.at.x + (corner & 1) * size, cell.at.y + (corner >> 1) * size, cell, receivers);
}

bool ReceiverGrid::is_finest(const Cell& cell) const {
    const float edge = static_cast<float>(steps_of(cell.level)) * std::min(step_.x, step_.y);
    return cell.level == max_level || edge < finest_;
}

void ReceiverGrid::cut(std::size_t index, std::vector<Receiver>& receivers) {
    const auto first = static_cast<std::uint32_t>(cells_.size());
    const int half = steps_of(cells_[index].level + 1);
    for (int quarter = 0; quarter < 4; ++quarter) {
        Cell child;
        child.level = cells_[index].level + 1;
        child.at = cells_[index].at + V2i((quarter & 1) * half, (quarter >> 1) * half);
        finish(child, receivers);
        cells_.push_back(child);
    }
    cells_[index].first_child = first;
}

std::pair<const ReceiverGrid::Cell*, std::array<float, 4>> ReceiverGrid::locate(const V2f& place) const {
    const auto steps = [&](int axis) {
        const float most = static_cast<float>(count_[axis] * finest_steps);
        return std::clamp((place[axis] - low_[axis]) / step_[axis], 0.0F, most);
    };
    const V2f at(steps(0), steps(1));
    const int x = std::min(static_cast<int>(at.x) / finest_steps, count_.x - 1);
    const int y = std::min(static_cast<int>(at.y) / finest_steps, count_.y - 1);
    const Cell* cell =
        &cells_[static_cast<std::size_t>(y) * static_cast<std::size_t>(count_.x) + static_cast<std::size_t>(x)];
    while (cell->first_child != 0) {
        const int half = steps_of(cell->level + 1);
        const int right = at.x >= static_cast<float>(cell->at.x + half) ? 1 : 0;
        const int upper = at.y >= static_cast<float>(cell->at.y + half) ? 2 : 0;
        cell = &cells_[cell->first_child + static_cast<std::size_t>(right + upper)];
    }
    const auto size = static_cast<float>(steps_of(cell->level));
    const float u = std::clamp((at.x - static_cast<float>(cell->at.x)) / size, 0.0F, 1.0F);
    const float v = std::clamp((at.y - static_cast<float>(cell->at.y)) / size, 0.0F, 1.0F);
    return {cell, {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v}};
}

}  // namespace vmap
