// SPDX-License-Identifier: Apache-2.0
/// \file
/// From the pairs that the threads of a builder link to the map.
#pragma once

#include "node_pairs.h"

#include <vmap/progress.h>
#include <vmap/visibility_map.h>

#include <tbb/enumerable_thread_specific.h>

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

namespace vmap {

class LinkCollector {
public:
    /// - all_pairs: of leaves, that will have been decided at the end
    LinkCollector(const ProgressCallback& progress, std::uint64_t all_pairs)
        : progress_(progress), all_pairs_(all_pairs) {}

    void link(const NodePair& pair) { shares_.local().links.push_back(pair); }
    void hide(const NodePair& pair) { shares_.local().hidden.push_back(pair); }

    /// So many pairs of leaves are decided. Reports progress now and then.
    void count_decided(std::uint64_t pairs);

    /// The map of what was linked, each pair once; the order in which it came in does not matter.
    ///
    /// - nodes: of the tree
    [[nodiscard]] VisibilityMap collect(std::size_t nodes, VisibilityRule rule);

private:
    /// What one thread has found.
    struct Share {
        std::vector<NodePair> links;
        std::vector<NodePair> hidden;
        std::uint64_t decided_pairs = 0;  ///< of leaves, not yet reported
    };

    const ProgressCallback& progress_;
    std::uint64_t all_pairs_;
    std::uint64_t decided_pairs_ = 0;
    std::mutex progress_mutex_;
    tbb::enumerable_thread_specific<Share> shares_;
};

}  // namespace vmap
