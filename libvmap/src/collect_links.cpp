// SPDX-License-Identifier: Apache-2.0
#include "collect_links.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace vmap {

VisibilityMap collect_links(std::size_t nodes, const std::vector<std::vector<NodePair>>& links) {
    VisibilityMap map;
    map.first_link.resize(nodes + 1);
    for (const std::vector<NodePair>& part : links)
        for (const NodePair& link : part) {
            ++map.first_link[link.first + 1];
            ++map.first_link[link.second + 1];
        }
    for (std::size_t n = 0; n < nodes; ++n) map.first_link[n + 1] += map.first_link[n];

    map.partners.resize(map.first_link[nodes]);
    std::vector<std::uint64_t> next(map.first_link.begin(), map.first_link.end() - 1);
    for (const std::vector<NodePair>& part : links)
        for (const NodePair& link : part) {
            map.partners[next[link.first]++] = link.second;
            map.partners[next[link.second]++] = link.first;
        }
    tbb::parallel_for(std::size_t{0}, nodes, [&](std::size_t n) {
        const auto begin = map.partners.begin();
        std::sort(begin + static_cast<std::ptrdiff_t>(map.first_link[n]),
                  begin + static_cast<std::ptrdiff_t>(map.first_link[n + 1]));
    });
    return map;
}

}  // namespace vmap
