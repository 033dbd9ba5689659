// SPDX-License-Identifier: Apache-2.0
#include <vmap/leaf_ranges.h>
#include <vmap/visibility_map.h>

#include <algorithm>

namespace vmap {

bool has_link(const VisibilityMap& map, std::uint32_t a, std::uint32_t b) {
    const auto links_a = map.links_of(a);
    const auto links_b = map.links_of(b);
    return links_a.size() < links_b.size() ? std::ranges::binary_search(links_a, b)
                                           : std::ranges::binary_search(links_b, a);
}

std::uint64_t visible_leaf_pairs(const Tree& tree, const VisibilityMap& map) {
    const std::vector<LeafRange> ranges = leaf_ranges(tree);
    std::uint64_t pairs = 0;
    for (std::uint32_t n = 0; n < ranges.size(); ++n)
        for (const std::uint32_t partner : map.links_of(n))
            pairs += static_cast<std::uint64_t>(ranges[n].size()) * ranges[partner].size();
    return pairs;
}

}  // namespace vmap
