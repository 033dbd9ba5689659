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
        std::size_t crossing = 0;
        if (const auto outcome = decide_by_middle(pair, facing, on_middle, crossing)) return outcome;
        return decide_by_shaft(pair, facing, crossing, between);
    }

    /// The first half of it, which does without the patches beside the middle: one patch may hide all, and leaves of
    /// which several may hide something cannot be split.
    ///
    /// - crossing: number of patches that cross the segment between the middles
    [[nodiscard]] std::optional<PatchOutcome> decide_by_middle(const NodePair& pair, Facing facing,
                                                               std::span<const std::uint32_t> on_middle,
                                                               std::size_t& crossing) const {
        if (!are_surface(pair)) return std::nullopt;
        const auto [a, b] = pair;
        for (const std::uint32_t k : on_middle) {
            if (!visibility_.crosses_middle(k, a, b)) continue;
            if (visibility_.covers(k, a, b)) return PatchOutcome::hidden;
            ++crossing;
        }
        if (are_leaves(pair) && !may_be_visible(facing, crossing)) return PatchOutcome::partial;
        return std::nullopt;
    }

    /// The second half.
    [[nodiscard]] std::optional<PatchOutcome> decide_by_shaft(const NodePair& pair, Facing facing, std::size_t crossing,
                                                              std::span<const std::uint32_t> between) const {
        if (!are_surface(pair)) return std::nullopt;
        const auto [a, b] = pair;
        if (may_be_visible(facing, crossing)) {
            const PatchShaft shaft = visibility_.shaft(a, b);
            std::size_t entered = crossing;
            for (const std::uint32_t k : between) {
                if (visibility_.crosses_middle(k, a, b) || !visibility_.enters(k, a, b, shaft)) continue;
                if (++entered > few_patches_) break;
            }
            if (entered == 0) return PatchOutcome::visible;
            if (entered <= few_patches_) return PatchOutcome::partial;
        }
        if (are_leaves(pair)) return PatchOutcome::partial;
        return std::nullopt;
    }

    /// Whether both nodes are parts of patches; others are decided by facing alone.
    [[nodiscard]] bool are_surface(const NodePair& pair) const {
        return node(pair.first).patch != no_index && node(pair.second).patch != no_index;
    }

    /// Whether a pair may turn out visible, or partial before it is split to the end: only then its shaft matters.
    [[nodiscard]] bool may_be_visible(Facing facing, std::size_t crossing) const {
        return facing == Facing::all && crossing <= few_patches_;
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
    [[nodiscard]] const TreeNode& node(std::uint32_t n) const { return visibility_.tree().nodes[n]; }
    [[nodiscard]] bool are_leaves(const NodePair& pair) const {
        return node(pair.first).is_leaf() && node(pair.second).is_leaf();
    }

    const PatchVisibility& visibility_;
    std::uint32_t few_patches_;
};

}  // namespace vmap
