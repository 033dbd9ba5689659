// SPDX-License-Identifier: Apache-2.0
#include "leaf_pairs.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace vmap {
namespace {

/// The bits of one word that belong to leaves begin to end, when the word's first bit is that of leaf `first`.
std::uint64_t word_mask(const LeafRange& range, std::size_t first) {
    const std::size_t begin = std::max<std::size_t>(range.begin, first) - first;
    const std::size_t end = std::min<std::size_t>(range.end, first + 64) - first;
    const std::uint64_t below_end = end == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << end) - 1;
    return below_end & ~std::uint64_t{0} << begin;
}

std::size_t first_block(const LeafRange& range) {
    return range.begin / 64;
}
std::size_t last_block(const LeafRange& range) {
    return (range.end - 1) / 64;
}

}  // namespace

LeafPairs::LeafPairs(const Tree& tree, const std::vector<LeafRange>& ranges, std::span<const std::uint64_t> first_link,
                     std::span<const std::uint32_t> partners)
    : leaves_(tree.leaves.size()), side_((leaves_ + 63) / 64), blocks_(side_ * side_), rows_(side_) {
    // Nodes within one row of blocks are added row by row, in parallel; the few larger ones before them.
    std::vector<std::vector<std::uint32_t>> nodes_of_row(side_);
    const auto add_links = [&](std::uint32_t n) {
        for (std::uint64_t i = first_link[n]; i < first_link[n + 1]; ++i) add(ranges[n], ranges[partners[i]]);
    };
    for (std::uint32_t n = 0; n < tree.nodes.size(); ++n) {
        if (first_link[n] == first_link[n + 1]) continue;
        if (first_block(ranges[n]) == last_block(ranges[n]))
            nodes_of_row[first_block(ranges[n])].push_back(n);
        else
            add_links(n);
    }
    tbb::parallel_for(std::size_t{0}, side_, [&](std::size_t row) {
        for (const std::uint32_t n : nodes_of_row[row]) add_links(n);
        simplify(row);
    });
}

std::uint64_t LeafPairs::columns_of(std::size_t block) const {
    return word_mask({0, static_cast<std::uint32_t>(leaves_)}, 64 * block);
}

void LeafPairs::add(const LeafRange& a, const LeafRange& b) {
    for (std::size_t row = first_block(a); row <= last_block(a); ++row) {
        const std::uint64_t rows = word_mask(a, 64 * row);
        for (std::size_t column = first_block(b); column <= last_block(b); ++column) {
            std::uint32_t& block = blocks_[row * side_ + column];
            if (block == all) continue;
            const std::uint64_t columns = word_mask(b, 64 * column);
            if (rows == columns_of(row) && columns == columns_of(column)) {
                block = all;
                continue;
            }
            if (block == none) {
                block = mixed + static_cast<std::uint32_t>(rows_[row].size());
                rows_[row].resize(rows_[row].size() + 64);
            }
            for (std::uint64_t left = rows; left != 0; left &= left - 1)
                rows_[row][block - mixed + static_cast<std::size_t>(__builtin_ctzll(left))] |= columns;
        }
    }
}

/// Blocks that many links have filled become `all`.
void LeafPairs::simplify(std::size_t row) {
    const auto rows = static_cast<std::size_t>(__builtin_popcountll(columns_of(row)));
    for (std::size_t column = 0; column < side_; ++column) {
        std::uint32_t& block = blocks_[row * side_ + column];
        if (block < mixed) continue;
        const auto words = rows_[row].begin() + (block - mixed);
        const std::uint64_t full = columns_of(column);
        if (std::all_of(words, words + static_cast<std::ptrdiff_t>(rows), [&](std::uint64_t w) { return w == full; }))
            block = all;
    }
}

PairStatus LeafPairs::status(const LeafRange& a, const LeafRange& b) const {
    bool some = false;
    bool every = true;
    for (std::size_t row = first_block(a); row <= last_block(a); ++row)
        for (std::size_t column = first_block(b); column <= last_block(b); ++column) {
            const std::uint32_t block = blocks_[row * side_ + column];
            if (block == all) {
                some = true;
            } else if (block == none) {
                every = false;
            } else {
                const std::uint64_t columns = word_mask(b, 64 * column);
                for (std::uint64_t left = word_mask(a, 64 * row); left != 0; left &= left - 1) {
                    const std::uint64_t bits =
                        rows_[row][block - mixed + static_cast<std::size_t>(__builtin_ctzll(left))] & columns;
                    some |= bits != 0;
                    every &= bits == columns;
                }
            }
            if (some && !every) return PairStatus::partial;
        }
    return every ? PairStatus::visible : PairStatus::invisible;
}

}  // namespace vmap
