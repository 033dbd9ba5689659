// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Nodes as trees: their order and their places in the world. Nothing here recurses, however deep the trees are.
#pragma once

#include "document.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vmap::gltf {

/// Checks that the nodes form trees whose roots are what the scenes name, turns every node's pose from parent_from_node
/// into world_from_node, and hides what hangs under hidden nodes.
///
/// - throws BrokenContent for a cycle, a node with two parents, or a scene that names a node twice or one with a parent
void place_nodes(Document& document);

/// Finds a scene by its name, or by its index when no scene has that name; without a wish the default or the first one.
///
/// - returns nothing when there is none like that
[[nodiscard]] std::optional<std::size_t> find_scene(const Document& document, const std::optional<std::string>& wanted);

/// The nodes of a scene, each after its parent and all in the order of the file.
[[nodiscard]] std::vector<std::uint32_t> nodes_of(const Document& document, const SceneEntry& scene);

}  // namespace vmap::gltf
