// SPDX-License-Identifier: Apache-2.0
/// \file
/// Direct light on one tile of points: what all of it sees whole, what none of it sees, and what is in between.
#pragma once

#include "emitter.h"
#include "light_tree.h"
#include "surface.h"

#include <vmap/light_source.h>

#include <cstdint>
#include <span>
#include <vector>

namespace vmap {

/// All lights of a scene, and two trees over the many of them.
struct Lights {
    std::span<const Emitter> emitters;
    std::span<const LightSource> sources;
    LightTree emitter_tree;              ///< members are indices into emitters
    LightTree source_tree;               ///< members are indices into point_sources
    std::vector<std::uint32_t> points;   ///< sources that shine in every direction
    std::vector<std::uint32_t> singles;  ///< and the others

    Lights(std::span<const Emitter> emissive, std::span<const LightSource> punctual, const Imath::V3d& origin);
};

/// Lights one tile; holds what is used again from light to light.
class TileLighter {
public:
    /// - tolerance: mean |dE| / mean E that the whole computation may have
    TileLighter(const Surface& surface, const Tile& tile, const Lights& lights, double tolerance, std::uint64_t seed,
                std::span<Imath::C3f> irradiance);

    /// Adds the light of all lights to the tile's points.
    void run();

private:
    using Outline = std::vector<Imath::V3d>;
    struct Part {
        const LightTree* tree;
        std::uint32_t node;
        double strength;  ///< about what it would bring to the tile, unblocked
    };

    void choose_parts(const LightTree& tree);
    void add_part(const Part& part, double share);
    void add(const Emitter& emitter, const LightTree::Node& node, double share);
    void add(const LightSource& source);
    void add_cluster(const LightTree& tree, const LightTree::Node& node, double share);

    template <class Use>
    void for_each_point(const Use& use) const;
    template <class Keep>
    void find_blockers(const Imath::Box3f& end, const Keep& keep);

    [[nodiscard]] bool is_out_of_sight(const LightTree::Node& node) const;
    [[nodiscard]] bool is_far(const LightTree::Node& node) const;
    [[nodiscard]] bool faces_the_tile(const LightTree::Node& node) const;
    [[nodiscard]] bool rises_over(const Emitter& emitter, std::span<const Imath::V3f> outline) const;
    [[nodiscard]] bool rises_over_the_tile(std::span<const Imath::V3f> outline) const;
    [[nodiscard]] Imath::C3f far_light(const LightTree& tree, const LightTree::Node& node, bool facing,
                                       const Imath::V3f& position, const Imath::V3f& normal) const;
    [[nodiscard]] Imath::V3d place_in(const LightTree& tree, std::uint32_t member, const Imath::V2d& sample) const;
    [[nodiscard]] double visible_share(const LightTree& tree, const LightTree::Node& node, std::uint32_t point,
                                       const Imath::V3d& position, const Imath::V3d& normal, std::uint32_t rays) const;

    const Surface& surface_;
    const Tile& tile_;
    const Patch& patch_;
    const Lights& lights_;
    float opening_;    ///< radius over distance below which lights count as one
    float clearance_;  ///< how far above the surface segments start, world units
    std::uint64_t seed_;
    std::span<Imath::C3f> irradiance_;
    std::vector<Part> parts_;
    std::vector<std::uint32_t> found_;
    std::vector<Outline> blockers_;
};

}  // namespace vmap
