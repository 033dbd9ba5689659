// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// One scene of a document as the rest of the toolkit sees it.
#pragma once

#include "../scene_folder.h"
#include "buffers.h"
#include "document.h"

#include <vmap/importers/input.h>

namespace vmap::gltf {

/// Reads what the nodes of a scene hold: meshes, points, lights, cameras and the images that they need.
///
/// - document: its nodes are placed in the world
/// - returns an Input without the names of its format and source, warnings and extensions
/// - throws BrokenContent for data that break the specification, UnsupportedContent for a scene that exceeds a limit or
///   holds neither surface nor points
[[nodiscard]] Input build_scene(const Document& document, const SceneEntry& scene, Buffers& buffers,
                                const SceneFolder& folder, Warnings& warnings);

}  // namespace vmap::gltf
