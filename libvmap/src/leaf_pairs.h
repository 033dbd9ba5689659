// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which leaf sees which, to be asked for any pair in two reads of memory: the links spread out over 64 x 64 blocks of
/// leaf pairs, of which most are all visible or all invisible.
#pragma once

#include <vmap/leaf_ranges.h>
#include <vmap/visibility_map.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vmap {

class LeafPairs {
public:
    /// - first_link, partners: as in VisibilityMap
    LeafPairs(const Tree& tree, const std::vector<LeafRange>& ranges, std::span<const std::uint64_t> first_link,
              std::span<const std::uint32_t> partners);

    [[nodiscard]] bool has(std::uint32_t a, std::uint32_t b) const {
        const std::uint32_t block = blocks_[a / 64 * side_ + b / 64];
        return block < mixed ? block == all : (rows_[a / 64][block - mixed + a % 64] >> b % 64 & 1) != 0;
    }

    /// What the leaves of one range see of those of another.
    [[nodiscard]] PairStatus status(const LeafRange& a, const LeafRange& b) const;

private:
    static constexpr std::uint32_t none = 0;
    static constexpr std::uint32_t all = 1;
    static constexpr std::uint32_t mixed = 2;  ///< and above: where the block's words begin in its row of blocks

    void add(const LeafRange& a, const LeafRange& b);
    void simplify(std::size_t row);
    [[nodiscard]] std::uint64_t columns_of(std::size_t block) const;

    std::size_t leaves_ = 0;
    std::size_t side_ = 0;
    std::vector<std::uint32_t> blocks_;
    std::vector<std::vector<std::uint64_t>> rows_;  ///< 64 words for each mixed block of a row of blocks
};

}  // namespace vmap
