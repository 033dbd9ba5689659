// SPDX-License-Identifier: Apache-2.0
#include "build_methods.h"
#include "node_pairs.h"

#include <vmap/leaf_visibility.h>

#include <algorithm>

namespace vmap {
namespace {

/// The seed's algorithm with the seed's names: o-IL and n-IL are the old and the new interaction list.
class SeedBuilder {
public:
    SeedBuilder(const Tree& tree, const ProgressCallback& progress)
        : tree_(tree),
          leaves_(tree),
          split_(tree),
          progress_(progress),
          old_lists_(tree.nodes.size()),
          new_lists_(tree.nodes.size()) {
        for (const NodePair& pair : sibling_pairs(tree)) {
            old_lists_[pair.first].push_back(pair.second);
            old_lists_[pair.second].push_back(pair.first);
        }
    }

    VisibilityMap run() {
        if (!tree_.nodes.empty()) octree_visibility(0);
        VisibilityMap map;
        map.first_link.push_back(0);
        for (std::vector<std::uint32_t>& list : new_lists_) {
            std::ranges::sort(list);
            map.partners.insert(map.partners.end(), list.begin(), list.end());
            map.first_link.push_back(map.partners.size());
        }
        return map;
    }

private:
    void octree_visibility(std::uint32_t a) {
        report_progress(
            progress_, "vmap",
            static_cast<double>(tree_.nodes[a].first_point) / static_cast<double>(tree_.point_order.size()));
        for (const std::uint32_t b : old_lists_[a]) {
            const NodePair pair =
                tree_.nodes[a].first_point < tree_.nodes[b].first_point ? NodePair{a, b} : NodePair{b, a};
            if (node_to_node_visibility(pair) == PairStatus::visible) link(pair);
            std::erase(old_lists_[b], a);
        }
        for (std::uint32_t c = 0; c < tree_.nodes[a].child_count; ++c)
            octree_visibility(tree_.nodes[a].first_child + c);
    }

    /// Links all descendants of the two with each other at the highest level, short of the two themselves.
    PairStatus node_to_node_visibility(const NodePair& pair) {
        if (split_.is_done(pair))
            return leaves_.sees(tree_.nodes[pair.first].leaf, tree_.nodes[pair.second].leaf) ? PairStatus::visible
                                                                                             : PairStatus::invisible;
        std::vector<NodePair> visible;
        bool all = true;
        bool none = true;
        split_.for_each_part(tree_, pair, [&](const NodePair& part) {
            const PairStatus status = node_to_node_visibility(part);
            if (status == PairStatus::visible) visible.push_back(part);
            all &= status == PairStatus::visible;
            none &= status == PairStatus::invisible;
        });
        if (all) return PairStatus::visible;
        for (const NodePair& part : visible) link(part);
        return none ? PairStatus::invisible : PairStatus::partial;
    }

    void link(const NodePair& pair) {
        new_lists_[pair.first].push_back(pair.second);
        new_lists_[pair.second].push_back(pair.first);
    }

    const Tree& tree_;
    LeafVisibility leaves_;
    PairSplit split_;
    const ProgressCallback& progress_;
    std::vector<std::vector<std::uint32_t>> old_lists_;
    std::vector<std::vector<std::uint32_t>> new_lists_;
};

}  // namespace

VisibilityMap build_as_seed(const Tree& tree, const ProgressCallback& progress) {
    return SeedBuilder(tree, progress).run();
}

}  // namespace vmap
