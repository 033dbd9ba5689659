// SPDX-License-Identifier: Apache-2.0
/// \file
/// Lights as a tree: many that are close together, seen from afar, count as one.
///
/// This work is based on:
///   B. Walter et al., "Lightcuts: a scalable approach to illumination", SIGGRAPH 2005.
#pragma once

#include <Imath/ImathBox.h>
#include <Imath/ImathColor.h>
#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace vmap {

/// A light as it looks from afar.
struct FarLight {
    Imath::V3f center{0, 0, 0};
    Imath::V3f normal{0, 0, 0};  ///< it sends power * cosine from it; zero: power in every direction
    Imath::C3f power{0, 0, 0};   ///< W/sr, along the normal if it has one
    Imath::Box3f bounds;
    std::uint32_t patch = no_patch;
    float turn = 0;  ///< sine of how far its normals lie around its own

    static constexpr std::uint32_t no_patch = 0xFFFFFFFFU;
};

class LightTree {
public:
    struct Node {
        Imath::Box3f bounds;
        Imath::V3f center{0, 0, 0};  ///< mean of the members' places, weighted with their power
        float radius = 0;            ///< everything of it lies so near to the centre
        Imath::C3f power{0, 0, 0};   ///< sum over the members
        std::array<Imath::V3f, 3> flow{Imath::V3f(0), Imath::V3f(0), Imath::V3f(0)};  ///< sum of power * normal
        Imath::V3f axis{0, 0, 0};  ///< unit; the members' normals lie around it
        float cone_angle = 0;      ///< at most so far from it, radians; pi when that says nothing
        std::uint32_t first = 0;   ///< of its members, in members()
        std::uint32_t count = 0;
        std::uint32_t right = 0;  ///< second child; the first one is the next node; 0: one member
    };

    LightTree() = default;
    explicit LightTree(std::vector<FarLight> lights);

    [[nodiscard]] bool empty() const { return lights_.empty(); }
    [[nodiscard]] std::span<const Node> nodes() const { return nodes_; }
    [[nodiscard]] const FarLight& light(std::uint32_t index) const { return lights_[index]; }
    /// The lights, node after node.
    [[nodiscard]] std::span<const std::uint32_t> members(const Node& node) const {
        return std::span(order_).subspan(node.first, node.count);
    }
    /// The member at which a share of the node's power, in [0, 1), is reached.
    [[nodiscard]] std::uint32_t member_at(const Node& node, double share) const;

private:
    void build(std::uint32_t first, std::uint32_t count);
    [[nodiscard]] std::uint32_t halve(const Node& node);
    void sum_up(Node& node) const;

    std::vector<FarLight> lights_;
    std::vector<std::uint32_t> order_;
    std::vector<double> sums_;  ///< of the power up to each place of order_
    std::vector<Node> nodes_;
};

}  // namespace vmap
