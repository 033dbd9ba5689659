// SPDX-License-Identifier: Apache-2.0
#include "light_tree.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace vmap {
namespace {

using Imath::Box3f;
using Imath::V3f;

double brightness(const FarLight& light) {
    return static_cast<double>(light.power.x + light.power.y + light.power.z);
}

}  // namespace

LightTree::LightTree(std::vector<FarLight> lights) : lights_(std::move(lights)), order_(lights_.size()) {
    if (lights_.empty()) return;
    std::iota(order_.begin(), order_.end(), 0U);
    nodes_.reserve(2 * lights_.size());
    build(0, static_cast<std::uint32_t>(lights_.size()));
    double sum = 0;
    for (const std::uint32_t i : order_) sums_.push_back(sum += brightness(lights_[i]));
}

std::uint32_t LightTree::member_at(const Node& node, double share) const {
    const double before = node.first == 0 ? 0 : sums_[node.first - 1];
    const double target = before + share * (sums_[node.first + node.count - 1] - before);
    const auto begin = sums_.begin() + node.first;
    const auto at = std::upper_bound(begin, begin + node.count - 1, target);
    return order_[static_cast<std::size_t>(at - sums_.begin())];
}

void LightTree::build(std::uint32_t first, std::uint32_t count) {
    const std::size_t index = nodes_.size();
    nodes_.emplace_back();
    nodes_[index].first = first;
    nodes_[index].count = count;
    sum_up(nodes_[index]);
    if (count == 1) return;
    const std::uint32_t left = halve(nodes_[index]);
    build(first, left);
    nodes_[index].right = static_cast<std::uint32_t>(nodes_.size());
    build(first + left, count - left);
}

void LightTree::sum_up(Node& node) const {
    double total = 0;
    Imath::V3d center(0);
    V3f normals(0);
    for (const std::uint32_t i : members(node)) {
        const FarLight& light = lights_[i];
        node.bounds.extendBy(light.bounds);
        node.power += light.power;
        for (int c = 0; c < 3; ++c) node.flow.at(static_cast<std::size_t>(c)) += light.normal * light.power[c];
        normals += light.normal;
        center += Imath::V3d(light.center) * brightness(light);
        total += brightness(light);
    }
    node.center = total > 0 ? V3f(center / total) : node.bounds.center();
    V3f farthest(0);
    for (int axis = 0; axis < 3; ++axis)
        farthest[axis] = std::max(node.bounds.max[axis] - node.center[axis], node.center[axis] - node.bounds.min[axis]);
    node.radius = farthest.length();

    node.cone_angle = std::numbers::pi_v<float>;
    if (!(normals.length() > 1e-3F * static_cast<float>(node.count))) return;
    node.axis = normals.normalized();
    float least = 1;
    for (const std::uint32_t i : members(node)) least = std::min(least, node.axis.dot(lights_[i].normal));
    node.cone_angle = std::acos(std::clamp(least, -1.0F, 1.0F));
}

std::uint32_t LightTree::halve(const Node& node) {
    Box3f places;
    Box3f normals;
    float largest = 0;
    for (const std::uint32_t i : members(node)) {
        places.extendBy(lights_[i].center);
        normals.extendBy(lights_[i].normal);
        largest = std::max(largest, lights_[i].bounds.size().length());
    }
    // What lies together is parted by the way it faces: the two sides of a sheet, the sides of a lamp.
    const int turn = static_cast<int>(normals.majorAxis());
    const bool by_normal = normals.size()[turn] > 1 && places.size().length() < 4 * largest;
    const int axis = by_normal ? turn : static_cast<int>(places.majorAxis());
    const auto value = [&](std::uint32_t i) { return by_normal ? lights_[i].normal[axis] : lights_[i].center[axis]; };
    const auto begin = order_.begin() + node.first;
    const auto end = begin + node.count;
    const float at = by_normal ? normals.center()[axis] : places.center()[axis];
    const auto middle = std::partition(begin, end, [&](std::uint32_t i) { return value(i) < at; });
    const auto left = static_cast<std::uint32_t>(middle - begin);
    return left == 0 || left == node.count ? node.count / 2 : left;
}

}  // namespace vmap
