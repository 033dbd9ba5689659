// SPDX-License-Identifier: Apache-2.0
#include "collect_links.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

namespace vmap {
namespace {

/// Both directions of each pair, node after node, ascending.
void sort_by_node(std::size_t nodes, const std::vector<std::vector<NodePair>>& parts,
                  std::vector<std::uint64_t>& first_partner, std::vector<std::uint32_t>& partners) {
    first_partner.resize(nodes + 1);
    for (const std::vector<NodePair>& part : parts)
        for (const NodePair& pair : part) {
            ++first_partner[pair.first + 1];
            ++first_partner[pair.second + 1];
        }
    for (std::size_t n = 0; n < nodes; ++n) first_partner[n + 1] += first_partner[n];

    partners.resize(first_partner[nodes]);
    std::vector<std::uint64_t> next(first_partner.begin(), first_partner.end() - 1);
    for (const std::vector<NodePair>& part : parts)
        for (const NodePair& pair : part) {
            partners[next[pair.first]++] = pair.second;
            partners[next[pair.second]++] = pair.first;
        }
    tbb::parallel_for(std::size_t{0}, nodes, [&](std::size_t n) {
        const auto begin = partners.begin();
        std::sort(begin + static_cast<std::ptrdiff_t>(first_partner[n]),
                  begin + static_cast<std::ptrdiff_t>(first_partner[n + 1]));
    });
}

}  // namespace

void LinkCollector::count_decided(std::uint64_t pairs) {
    std::uint64_t& decided = shares_.local().decided_pairs;
    decided += pairs;
    if (decided <= all_pairs_ / 200) return;
    const std::scoped_lock lock(progress_mutex_);
    decided_pairs_ += std::exchange(decided, 0);
    report_progress(progress_, "vmap", static_cast<double>(decided_pairs_) / static_cast<double>(all_pairs_));
}

VisibilityMap LinkCollector::collect(std::size_t nodes, VisibilityRule rule) {
    std::vector<std::vector<NodePair>> links;
    std::vector<std::vector<NodePair>> hidden;
    for (Share& share : shares_) {
        links.push_back(std::move(share.links));
        hidden.push_back(std::move(share.hidden));
    }
    VisibilityMap map;
    map.rule = rule;
    sort_by_node(nodes, links, map.first_link, map.partners);
    if (rule == VisibilityRule::patch) sort_by_node(nodes, hidden, map.first_hidden, map.hidden);
    return map;
}

}  // namespace vmap
