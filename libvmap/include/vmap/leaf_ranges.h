// SPDX-License-Identifier: Apache-2.0
/// \file
/// The leaves under each node of a tree, which are one range of Tree::leaves.
#pragma once

#include <vmap/tree.h>

#include <cstdint>
#include <vector>

namespace vmap {

struct LeafRange {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;

    [[nodiscard]] std::uint32_t size() const { return end - begin; }
    [[nodiscard]] bool holds(std::uint32_t leaf) const { return begin <= leaf && leaf < end; }
};

/// One range per node.
[[nodiscard]] std::vector<LeafRange> leaf_ranges(const Tree& tree);

}  // namespace vmap
