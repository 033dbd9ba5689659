// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The images of a document, decoded.
#pragma once

#include "../scene_folder.h"
#include "buffers.h"
#include "document.h"

#include <vmap/scene.h>

#include <optional>
#include <vector>

namespace vmap::gltf {

/// Decodes the images that are used. One that cannot be read does not spoil the scene: it is left out with a warning.
///
/// - used: one per image of the document
/// - returns one per image of the document, empty where it is not used or left out
[[nodiscard]] std::vector<std::optional<Image>> load_images(const Document& document, const std::vector<bool>& used,
                                                            Buffers& buffers, const SceneFolder& folder,
                                                            Warnings& warnings);

}  // namespace vmap::gltf
