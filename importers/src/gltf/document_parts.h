// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The readers of a document's arrays, in the order in which they depend on each other.
#pragma once

#include "document.h"

namespace vmap::gltf {

/// asset.version, the required extensions and the names of all extensions that the document uses.
void read_asset_and_extensions(const JsonObject& root, Document& document, Warnings& warnings);

/// buffers, bufferViews and accessors
void read_storage(const JsonObject& root, Document& document);

/// samplers, textures, images and materials
void read_surfaces(const JsonObject& root, Document& document, Warnings& warnings);

/// meshes and skins
void read_geometry(const JsonObject& root, Document& document);

/// lights and cameras
void read_lights(const JsonObject& root, LightUnits units, Document& document, Warnings& warnings);
void read_cameras(const JsonObject& root, Document& document);

/// nodes and scenes
void read_nodes(const JsonObject& root, Document& document);
void read_scenes(const JsonObject& root, Document& document);

}  // namespace vmap::gltf
