// SPDX-License-Identifier: Apache-2.0
#include "build_methods.h"
#include "collect_links.h"
#include "leaf_blocks.h"
#include "node_bounds.h"
#include "occluders.h"
#include "shaft_cull.h"

#include <vmap/leaf_ranges.h>
#include <vmap/leaf_visibility.h>

#include <tbb/task_group.h>

#include <algorithm>
#include <numeric>

namespace vmap {
namespace {

constexpr std::uint64_t most_block_pairs = 2048;      ///< pairs of leaves that are decided together
constexpr std::uint64_t least_task_pairs = 1U << 18;  ///< fewer pairs of leaves are not worth a task

class FastBuilder {
public:
    FastBuilder(const Tree& tree, const ProgressCallback& progress)
        : tree_(tree),
          visibility_(tree),
          arrays_(visibility_),
          occluders_(visibility_),
          ranges_(leaf_ranges(tree)),
          bounds_(bound_nodes(visibility_, ranges_)),
          split_(tree),
          links_(progress, std::uint64_t{tree.leaves.size()} * tree.leaves.size() / 2) {}

    VisibilityMap run() {
        Candidates all{std::vector<std::uint32_t>(occluders_.walls.size()), DiscList(occluders_.discs)};
        std::iota(all.walls.begin(), all.walls.end(), 0U);
        const std::vector<NodePair> siblings = sibling_pairs(tree_);
        tbb::task_group tasks;
        for (const NodePair& pair : siblings) {
            const auto decide_pair = [this, &all, pair] {
                if (decide(pair, all, false) == PairStatus::visible) links_.link(pair);
            };
            if (leaf_pairs(pair) >= least_task_pairs)
                tasks.run(decide_pair);
            else
                decide_pair();
        }
        tasks.wait();
        return links_.collect(tree_.nodes.size(), VisibilityRule::centroid);
    }

private:
    /// The occluders that may matter to a pair.
    struct Candidates {
        std::vector<std::uint32_t> walls;
        DiscList discs;

        [[nodiscard]] bool empty() const { return walls.empty() && discs.empty(); }
    };

    [[nodiscard]] std::uint64_t leaf_pairs(const NodePair& pair) const {
        return std::uint64_t{ranges_[pair.first].size()} * ranges_[pair.second].size();
    }

    PairStatus done(const NodePair& pair, PairStatus status) {
        links_.count_decided(leaf_pairs(pair));
        return status;
    }

    /// Links the descendants of two nodes, short of the two themselves.
    ///
    /// - facing: it is known that all their leaves face each other
    PairStatus decide(const NodePair& pair, const Candidates& candidates, bool facing) {
        if (!facing) {
            const Facing found = facing_of(visibility_, bounds_[pair.first], bounds_[pair.second]);
            if (found == Facing::none) return done(pair, PairStatus::invisible);
            facing = found == Facing::all;
        }
        const TurnedBox& first = bounds_[pair.first].box;
        const TurnedBox& second = bounds_[pair.second].box;
        Candidates left{{}, DiscList(candidates.discs.size())};
        if (cull_walls(occluders_.walls, candidates.walls, first, second, left.walls) ||
            cull_discs(candidates.discs, first, second, !visibility_.walks_cells(), left.discs))
            return done(pair, PairStatus::invisible);
        if (facing && left.empty()) return done(pair, PairStatus::visible);

        const bool small = ranges_[pair.first].size() <= LeafBlock::width &&
                           ranges_[pair.second].size() <= LeafBlock::width && leaf_pairs(pair) <= most_block_pairs;
        return small ? done(pair, decide_block(pair, left, facing)) : decide_parts(pair, left, facing);
    }

    PairStatus decide_parts(const NodePair& pair, const Candidates& candidates, bool facing) {
        std::vector<NodePair> parts;
        split_.for_each_part(tree_, pair, [&](const NodePair& part) { parts.push_back(part); });
        std::vector<PairStatus> found(parts.size());
        tbb::task_group tasks;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const auto decide_part = [&, i] { found[i] = decide(parts[i], candidates, facing); };
            if (leaf_pairs(parts[i]) >= least_task_pairs)
                tasks.run(decide_part);
            else
                decide_part();
        }
        tasks.wait();
        return join(parts, found);
    }

    PairStatus decide_block(const NodePair& pair, const Candidates& candidates, bool facing) {
        LeafBlock block;
        block.rows = ranges_[pair.first];
        block.columns = ranges_[pair.second];
        if (facing)
            std::fill_n(block.bits.begin(), block.rows.size(), block.all_columns());
        else
            keep_facing(arrays_, block);
        for (const std::uint32_t wall : candidates.walls)
            if (!clear_behind(arrays_, occluders_.walls[wall], block)) return PairStatus::invisible;
        for (std::size_t i = 0; i < candidates.discs.size(); ++i)
            if (!clear_behind(arrays_, candidates.discs.at(i), visibility_, block)) return PairStatus::invisible;
        return link_block(pair, block);
    }

    /// The same as `decide` for a part of a block whose bits are final.
    PairStatus link_block(const NodePair& pair, const LeafBlock& block) {
        const LeafRange rows = ranges_[pair.first];
        const LeafRange columns = ranges_[pair.second];
        const std::uint64_t ones = columns.size() == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << columns.size()) - 1;
        const std::uint64_t mask = ones << (columns.begin - block.columns.begin);
        std::uint64_t any = 0;
        std::uint64_t all = mask;
        for (std::uint32_t row = rows.begin; row < rows.end; ++row) {
            const std::uint64_t bits = block.bits[row - block.rows.begin];
            any |= bits & mask;
            all &= bits;
        }
        if (any == 0) return PairStatus::invisible;
        if (all == mask) return PairStatus::visible;
        split_.for_each_part(tree_, pair, [&](const NodePair& part) {
            if (link_block(part, block) == PairStatus::visible) links_.link(part);
        });
        return PairStatus::partial;
    }

    /// Links the visible parts of a pair that is not visible as a whole.
    PairStatus join(const std::vector<NodePair>& parts, const std::vector<PairStatus>& found) {
        const auto all = [&](PairStatus status) {
            return std::ranges::all_of(found, [&](PairStatus s) { return s == status; });
        };
        if (all(PairStatus::visible)) return PairStatus::visible;
        if (all(PairStatus::invisible)) return PairStatus::invisible;
        for (std::size_t i = 0; i < parts.size(); ++i)
            if (found[i] == PairStatus::visible) links_.link(parts[i]);
        return PairStatus::partial;
    }

    const Tree& tree_;
    LeafVisibility visibility_;
    LeafArrays arrays_;
    Occluders occluders_;
    std::vector<LeafRange> ranges_;
    std::vector<NodeBounds> bounds_;
    PairSplit split_;
    LinkCollector links_;
};

}  // namespace

VisibilityMap build_fast(const Tree& tree, const ProgressCallback& progress) {
    return FastBuilder(tree, progress).run();
}

}  // namespace vmap
