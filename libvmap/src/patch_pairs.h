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

    /// How far the points of a pair face each other.
    ///
    /// - parent: the same of the pair that it is a part of
    [[nodiscard]] Facing facing(const NodePair& pair, Facing parent) const {
        return parent == Facing::all ? parent : visibility_.facing(pair.first, pair.second);
    }

    /// The outcome of a pair that is not averted, or none when it is to be split.
    ///
    /// - on_middle: at least all patches that the segment between the middles crosses
    /// - between: at least all patches that lie anywhere between the two
    [[nodiscard]] std::optional<PatchOutcome> decide(const NodePair& pair, Facing facing,
                                                     std::span<const std::uint32_t> on_middle,
                                                     std::span<const std::uint32_t> between) const {
        const auto [a, b] = pair;
        const TreeNode& first = visibility_.tree().nodes[a];
        const TreeNode& second = visibility_.tree().nodes[b];
        if (first.patch == no_index || second.patch == no_index) return std::nullopt;
        std::size_t entered = 0;
        for (const std::uint32_t k : on_middle) {
            if (!visibility_.crosses_middle(k, a, b)) continue;
            if (visibility_.covers(k, a, b)) return PatchOutcome::hidden;
            ++entered;
        }
        if (facing == Facing::all && entered <= few_patches_) {
            const PatchShaft shaft = visibility_.shaft(a, b);
            for (const std::uint32_t k : between) {
                if (visibility_.crosses_middle(k, a, b) || !visibility_.enters(k, a, b, shaft)) continue;
                if (++entered > few_patches_) break;
            }
            if (entered == 0) return PatchOutcome::visible;
            if (entered <= few_patches_) return PatchOutcome::partial;
        }
        if (first.is_leaf() && second.is_leaf()) return PatchOutcome::partial;
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
