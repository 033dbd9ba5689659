// SPDX-License-Identifier: Apache-2.0
/// \file
/// Whether a tree and a map that came from outside are sound, so that nothing that walks them can go astray.
#pragma once

#include <vmap/patch.h>
#include <vmap/tree.h>
#include <vmap/visibility_map.h>

#include <cstddef>
#include <string>

namespace vmap {

/// What is wrong with the tree of a cloud of so many points; empty when nothing is.
[[nodiscard]] std::string fault_of(const Tree& tree, std::size_t points);

/// What is wrong with the map of a tree; empty when nothing is.
[[nodiscard]] std::string fault_of(const VisibilityMap& map, const Tree& tree);

/// What is wrong with the patches that a tree is made of; empty when nothing is.
[[nodiscard]] std::string fault_of(const PatchSet& set, const Tree& tree);

}  // namespace vmap
