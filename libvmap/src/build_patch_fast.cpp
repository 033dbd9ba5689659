// SPDX-License-Identifier: Apache-2.0
#include "build_methods.h"
#include "collect_links.h"
#include "disc_list.h"
#include "patch_pairs.h"

#include <vmap/leaf_ranges.h>

#include <tbb/task_group.h>

#include <bit>

namespace vmap {
namespace {

using Imath::V3d;
using Imath::V3f;

constexpr std::uint64_t least_task_pairs = 1U << 14;  ///< fewer pairs of leaves are not worth a task

/// Hands the patches that may lie between two nodes down to their parts. A patch is culled as the disc around its
/// outline, in coordinates of which the scene's half diagonal is 1.
class FastPatchBuilder {
public:
    FastPatchBuilder(const PointCloud& cloud, const Tree& tree, const PatchSet& set, const PatchVmapConfig& config,
                     const ProgressCallback& progress)
        : tree_(tree),
          visibility_(cloud, tree, set),
          pairs_(visibility_, config.few_patches),
          split_(tree),
          ranges_(leaf_ranges(tree)),
          links_(progress, std::uint64_t{tree.leaves.size()} * tree.leaves.size() / 2) {
        if (tree.nodes.empty()) return;
        scale_ = visibility_.half_diagonal() > 0 ? 1 / visibility_.half_diagonal() : 1;
        boxes_.reserve(tree.nodes.size());
        for (std::uint32_t n = 0; n < tree.nodes.size(); ++n) boxes_.push_back(unit_box(visibility_.box(n)));
    }

    VisibilityMap run() {
        const DiscList all(all_discs());
        tbb::task_group tasks;
        for (const NodePair& pair : sibling_pairs(tree_))
            run_or_do(tasks, pair, [this, &all, pair] { keep(pair, decide(pair, Facing::some, all)); });
        tasks.wait();
        return links_.collect(tree_.nodes.size(), VisibilityRule::patch);
    }

private:
    [[nodiscard]] TurnedBox unit_box(const FramedBox& box) const {
        TurnedBox unit;
        unit.center = V3f(box.center * scale_);
        for (std::size_t axis = 0; axis < 3; ++axis)
            unit.half_axes[axis] =
                V3f(box.axes[axis] * ((box.half[static_cast<int>(axis)] + visibility_.box_growth()) * scale_));
        return unit;
    }

    [[nodiscard]] std::vector<LoneDisc> all_discs() const {
        const PatchSet& set = visibility_.set();
        std::vector<LoneDisc> discs;
        for (std::uint32_t p = 0; p < set.patches.size(); ++p) {
            const Patch& patch = set.patches[p];
            const PatchVisibility::Disc& around = visibility_.disc(p);
            const V3d at = (visibility_.center(p) + V3d(patch.u) * around.u + V3d(patch.v) * around.v) * scale_;
            const double radius = (around.radius + visibility_.eps()) * scale_;
            LoneDisc& disc = discs.emplace_back();
            disc.leaf = p;
            disc.plane = {patch.normal, patch.u, patch.v, static_cast<float>(V3d(patch.normal).dot(at)),
                          2 * bounds_margin};
            disc.disc = {0, static_cast<float>(V3d(patch.u).dot(at)), static_cast<float>(V3d(patch.v).dot(at)),
                         static_cast<float>(radius * radius)};
        }
        return discs;
    }

    [[nodiscard]] std::uint64_t leaf_pairs(const NodePair& pair) const {
        return std::uint64_t{ranges_[pair.first].size()} * ranges_[pair.second].size();
    }

    template <class Do>
    void run_or_do(tbb::task_group& tasks, const NodePair& pair, const Do& work) const {
        if (leaf_pairs(pair) >= least_task_pairs)
            tasks.run(work);
        else
            work();
    }

    void keep(const NodePair& pair, PatchOutcome outcome) {
        if (outcome == PatchOutcome::visible) links_.link(pair);
        if (outcome == PatchOutcome::hidden) links_.hide(pair);
    }

    PatchOutcome done(const NodePair& pair, PatchOutcome outcome) {
        links_.count_decided(leaf_pairs(pair));
        return outcome;
    }

    PatchOutcome decide(const NodePair& pair, Facing parent, const DiscList& candidates) {
        const Facing facing = pairs_.facing(pair, parent);
        if (facing == Facing::none) return done(pair, PatchOutcome::averted);
        // Most pairs are leaves, and most of those need no look beside their middle.
        std::size_t crossing = 0;
        if (const auto outcome = decide_by_middle(pair, facing, candidates, crossing)) return done(pair, *outcome);
        DiscList left(candidates.size());
        static_cast<void>(cull_discs(candidates, boxes_[pair.first], boxes_[pair.second], false, left));
        if (const auto outcome = decide_by_shaft(pair, facing, left, crossing)) return done(pair, *outcome);
        return decide_parts(pair, facing, left);
    }

    PatchOutcome decide_parts(const NodePair& pair, Facing facing, const DiscList& candidates) {
        std::vector<NodePair> parts;
        split_.for_each_part(tree_, pair, [&](const NodePair& part) { parts.push_back(part); });
        std::vector<PatchOutcome> found(parts.size());
        const auto decide_part = [&](std::size_t i) { found[i] = decide(parts[i], facing, candidates); };
        if (leaf_pairs(pair) < least_task_pairs) {
            for (std::size_t i = 0; i < parts.size(); ++i) decide_part(i);
        } else {
            tbb::task_group tasks;
            for (std::size_t i = 0; i < parts.size(); ++i)
                run_or_do(tasks, parts[i], [&decide_part, i] { decide_part(i); });
            tasks.wait();
        }
        const PatchOutcome joined = PatchPairs::join(found);
        if (joined == PatchOutcome::partial)
            for (std::size_t i = 0; i < parts.size(); ++i) keep(parts[i], found[i]);
        return joined;
    }

    [[nodiscard]] std::optional<PatchOutcome> decide_by_middle(const NodePair& pair, Facing facing,
                                                               const DiscList& candidates,
                                                               std::size_t& crossing) const {
        if (!pairs_.are_surface(pair)) return std::nullopt;
        std::vector<std::uint32_t> on_middle;
        find_on_middle(candidates, boxes_[pair.first].center, boxes_[pair.second].center, on_middle);
        return pairs_.decide_by_middle(pair, facing, on_middle, crossing);
    }

    [[nodiscard]] std::optional<PatchOutcome> decide_by_shaft(const NodePair& pair, Facing facing, const DiscList& left,
                                                              std::size_t crossing) const {
        std::vector<std::uint32_t> between;
        if (pairs_.may_be_visible(facing, crossing))
            for (std::size_t i = 0; i < left.size(); ++i)
                between.push_back(std::bit_cast<std::uint32_t>(left.field(DiscList::leaf)[i]));
        return pairs_.decide_by_shaft(pair, facing, crossing, between);
    }

    const Tree& tree_;
    PatchVisibility visibility_;
    PatchPairs pairs_;
    PairSplit split_;
    std::vector<LeafRange> ranges_;
    LinkCollector links_;
    double scale_ = 1;
    std::vector<TurnedBox> boxes_;
};

}  // namespace

VisibilityMap build_patch_fast(const PointCloud& cloud, const Tree& tree, const PatchSet& set,
                               const PatchVmapConfig& config, const ProgressCallback& progress) {
    return FastPatchBuilder(cloud, tree, set, config, progress).run();
}

}  // namespace vmap
