// SPDX-License-Identifier: Apache-2.0
/// \file
/// From the pairs that a builder links to the map.
#pragma once

#include "node_pairs.h"

#include <vmap/visibility_map.h>

#include <cstddef>
#include <vector>

namespace vmap {

/// - nodes: of the tree
/// - links: each pair of nodes once, in any order, in as many parts as the builder has
[[nodiscard]] VisibilityMap collect_links(std::size_t nodes, const std::vector<std::vector<NodePair>>& links);

}  // namespace vmap
