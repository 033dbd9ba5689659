// SPDX-License-Identifier: Apache-2.0
#include "build_methods.h"
#include "collect_links.h"

#include <vmap/error.h>
#include <vmap/leaf_ranges.h>
#include <vmap/leaf_visibility.h>

#include <tbb/parallel_for.h>

#include <atomic>
#include <bit>
#include <string>

namespace vmap {
namespace {

/// One bit for each ordered pair of leaves.
class BitMatrix {
public:
    explicit BitMatrix(std::size_t size) : words_((size + 63) / 64), bits_(size * words_) {}

    void set(std::size_t row, std::size_t column) {
        bits_[row * words_ + column / 64] |= std::uint64_t{1} << column % 64;
    }

    /// Bits that are set in a part of a row.
    [[nodiscard]] std::size_t count(std::size_t row, const LeafRange& columns) const {
        std::size_t set = 0;
        for (std::size_t word = columns.begin / 64; word * 64 < columns.end; ++word) {
            std::uint64_t bits = bits_[row * words_ + word];
            if (word == columns.begin / 64) bits &= ~std::uint64_t{0} << columns.begin % 64;
            if (word == columns.end / 64) bits &= ~(~std::uint64_t{0} << columns.end % 64);
            set += static_cast<std::size_t>(std::popcount(bits));
        }
        return set;
    }

private:
    std::size_t words_;
    std::vector<std::uint64_t> bits_;
};

BitMatrix see_all_pairs(const Tree& tree, const ProgressCallback& progress) {
    const LeafVisibility leaves(tree);
    BitMatrix matrix(leaves.size());
    constexpr std::size_t rows_at_once = 256;  // between two reports
    for (std::size_t begin = 0; begin < leaves.size(); begin += rows_at_once) {
        report_progress(progress, "vmap", static_cast<double>(begin) / static_cast<double>(leaves.size()));
        const std::size_t end = std::min(begin + rows_at_once, leaves.size());
        tbb::parallel_for(begin, end, [&](std::size_t row) {
            const auto a = static_cast<std::uint32_t>(row);
            for (std::uint32_t b = 0; b < leaves.size(); ++b)
                if (leaves.sees(a, b)) matrix.set(row, b);
        });
    }
    return matrix;
}

}  // namespace

VisibilityMap build_exhaustive(const Tree& tree, const ProgressCallback& progress) {
    constexpr std::size_t most_leaves = 100'000;
    if (tree.leaves.size() > most_leaves)
        throw UsageError("the tree has " + std::to_string(tree.leaves.size()) +
                         " leaves; the exhaustive method takes at most " + std::to_string(most_leaves));
    const BitMatrix matrix = see_all_pairs(tree, progress);
    const std::vector<LeafRange> ranges = leaf_ranges(tree);
    const PairSplit split(tree);

    const ProgressCallback silent;
    LinkCollector links(silent, 1);
    std::vector<NodePair> open = sibling_pairs(tree);
    while (!open.empty()) {
        const NodePair pair = open.back();
        open.pop_back();
        const LeafRange rows = ranges[pair.first];
        const LeafRange columns = ranges[pair.second];
        std::size_t seen = 0;
        for (std::uint32_t row = rows.begin; row < rows.end; ++row) seen += matrix.count(row, columns);
        if (seen == static_cast<std::size_t>(rows.size()) * columns.size())
            links.link(pair);
        else if (seen > 0)
            split.for_each_part(tree, pair, [&](const NodePair& part) { open.push_back(part); });
    }
    return links.collect(tree.nodes.size(), VisibilityRule::centroid);
}

}  // namespace vmap
