// SPDX-License-Identifier: Apache-2.0
/// \file
/// What every builder of the rule `patch` does with one pair of nodes, given the patches that may matter to it.
#pragma once

#include "node_pairs.h"

#include <vmap/patch_visibility.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace vmap {

enum class PatchOutcome : std::uint8_t {
    visible,
    averted,  ///< nothing faces
    hidden,   ///< patches lie between
    partial
};

class PatchPairs {
public:
    PatchPairs(const PatchVisibility& visibility, std::uint32_t few_patches)
        : visibility_(visibility), few_patches_(few_patches) {}

    [[nodiscard]] bool averted(const NodePair& pair) const {
        return visibility_.facing(pair.first, pair.second) == Facing::none;
    }

    /// The outcome of a pair that is not averted, or none when it is to be split.
    ///
    /// - candidates: at least all patches that lie anywhere between the two
    [[nodiscard]] std::optional<PatchOutcome> decide(const NodePair& pair,
                                                     std::span<const std::uint32_t> candidates) const {
        const Tree& tree = visibility_.tree();
        const TreeNode& first = tree.nodes[pair.first];
        const TreeNode& second = tree.nodes[pair.second];
        if (first.patch == no_index || second.patch == no_index) return std::nullopt;
        const bool facing = visibility_.facing(pair.first, pair.second) == Facing::all;
        std::size_t entered = 0;
        if (facing) {
            const PatchShaft shaft = visibility_.shaft(pair.first, pair.second);
            for (const std::uint32_t k : candidates) {
                if (!visibility_.enters(k, pair.first, pair.second, shaft)) continue;
                if (visibility_.covers(k, pair.first, pair.second)) return PatchOutcome::hidden;
                ++entered;
            }
            if (entered == 0) return PatchOutcome::visible;
        } else {
            for (const std::uint32_t k : candidates)
                if (visibility_.covers(k, pair.first, pair.second)) return PatchOutcome::hidden;
        }
        const bool few = facing && entered <= few_patches_;
        if (few || (first.is_leaf() && second.is_leaf())) return PatchOutcome::partial;
        return std::nullopt;
    }

    /// What the outcomes of all parts of a pair come to.
    [[nodiscard]] static PatchOutcome join(std::span<const PatchOutcome> parts) {
        const auto all = [&](auto... outcomes) {
            return std::ranges::all_of(parts, [&](PatchOutcome o) { return ((o == outcomes) || ...); });
        };
        if (all(PatchOutcome::visible)) return PatchOutcome::visible;
        if (all(PatchOutcome::averted)) return PatchOutcome::averted;
        if (all(PatchOutcome::averted, PatchOutcome::hidden)) return PatchOutcome::hidden;
        return PatchOutcome::partial;
    }

private:
    const PatchVisibility& visibility_;
    std::uint32_t few_patches_;
};

}  // namespace vmap
