// SPDX-License-Identifier: Apache-2.0
#include "build_methods.h"
#include "collect_links.h"
#include "patch_pairs.h"
#include "shaft.h"

#include <vmap/build_patch_vmap.h>

#include <numeric>

namespace vmap {
namespace {

void keep(LinkCollector& links, const NodePair& pair, PatchOutcome outcome) {
    if (outcome == PatchOutcome::visible) links.link(pair);
    if (outcome == PatchOutcome::hidden) links.hide(pair);
}

/// Every pair against all patches, or against those that a walk through their hierarchy finds near its shaft.
class PlainBuilder {
public:
    PlainBuilder(const PointCloud& cloud, const Tree& tree, const PatchSet& set, const PatchVmapConfig& config,
                 const ProgressCallback& progress)
        : tree_(tree),
          visibility_(cloud, tree, set),
          pairs_(visibility_, config.few_patches),
          split_(tree),
          progress_(progress),
          links_(progress_, 1),
          walks_(config.method == VmapMethod::seed),
          all_(set.patches.size()) {
        std::iota(all_.begin(), all_.end(), 0U);
    }

    VisibilityMap run() {
        if (!tree_.nodes.empty()) octree_visibility(0);
        return links_.collect(tree_.nodes.size(), VisibilityRule::patch);
    }

private:
    /// The seed's OctreeVisibility: the pairs of a node's children are its old interaction lists.
    void octree_visibility(std::uint32_t node) {
        const TreeNode& own = tree_.nodes[node];
        report_progress(progress_, "vmap",
                        static_cast<double>(own.first_point) / static_cast<double>(tree_.point_order.size()));
        for (std::uint32_t i = 0; i < own.child_count; ++i)
            for (std::uint32_t j = i + 1; j < own.child_count; ++j) {
                const NodePair pair{own.first_child + i, own.first_child + j};
                keep(links_, pair, node_to_node_visibility(pair, Facing::some));
            }
        for (std::uint32_t c = 0; c < own.child_count; ++c) octree_visibility(own.first_child + c);
    }

    /// The seed's NodeToNodeVisibility: links all descendants of the two, short of the two themselves.
    PatchOutcome node_to_node_visibility(const NodePair& pair, Facing parent) {
        const Facing facing = pairs_.facing(pair, parent);
        if (facing == Facing::none) return PatchOutcome::averted;
        const std::vector<std::uint32_t> found_near = walks_ ? near(pair) : std::vector<std::uint32_t>();
        const std::vector<std::uint32_t>& candidates = walks_ ? found_near : all_;
        if (const auto outcome = pairs_.decide(pair, facing, candidates, candidates)) return *outcome;
        std::vector<NodePair> parts;
        std::vector<PatchOutcome> found;
        split_.for_each_part(tree_, pair, [&](const NodePair& part) {
            parts.push_back(part);
            found.push_back(node_to_node_visibility(part, facing));
        });
        const PatchOutcome joined = PatchPairs::join(found);
        if (joined == PatchOutcome::partial)
            for (std::size_t i = 0; i < parts.size(); ++i) keep(links_, parts[i], found[i]);
        return joined;
    }

    /// The patches whose boxes come near the box of the two nodes.
    [[nodiscard]] std::vector<std::uint32_t> near(const NodePair& pair) const {
        std::vector<std::uint32_t> found;
        if (tree_.nodes[pair.first].patch == no_index || tree_.nodes[pair.second].patch == no_index) return found;
        Imath::Box3f box;
        for (const std::uint32_t n : {pair.first, pair.second})
            for (const Imath::V3d& corner : visibility_.box(n).corners()) box.extendBy(Imath::V3f(corner));
        const auto growth = static_cast<float>(2 * visibility_.box_growth());
        visibility_.bvh().polygons_in(Shaft::around(box, growth).half_spaces(), found);
        return found;
    }

    const Tree& tree_;
    PatchVisibility visibility_;
    PatchPairs pairs_;
    PairSplit split_;
    const ProgressCallback& progress_;
    LinkCollector links_;
    bool walks_;
    std::vector<std::uint32_t> all_;
};

}  // namespace

VisibilityMap build_patch_vmap(const PointCloud& cloud, const Tree& tree, const PatchSet& set,
                               const PatchVmapConfig& config, const ProgressCallback& progress) {
    if (config.method == VmapMethod::fast) return build_patch_fast(cloud, tree, set, config, progress);
    return PlainBuilder(cloud, tree, set, config, progress).run();
}

}  // namespace vmap
