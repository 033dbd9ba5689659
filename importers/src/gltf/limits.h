// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Limits of the glTF importer. They lie far above what scenes need and keep a hostile file from costing more memory or
/// time than its size is worth. docs/inputs.md shows them to users.
#pragma once

#include <cstddef>
#include <cstdint>

namespace vmap::gltf {

inline constexpr int deepest_nesting = 512;                     ///< of arrays and objects in the JSON text
inline constexpr std::uint64_t largest_file = 1ULL << 32U;      ///< bytes of the document; a GLB cannot be larger
inline constexpr std::uint64_t largest_image_file = 1U << 29U;  ///< bytes of one PNG or JPEG
inline constexpr std::size_t most_instances = 1U << 20U;        ///< meshes placed in one scene
inline constexpr std::uint64_t most_pixels = 1ULL << 28U;       ///< of all images together; four bytes each
inline constexpr std::uint64_t most_faces = 0xFFFFFFFF;         ///< over all instances, so that faces have 32-bit ids
inline constexpr double largest_coordinate = 1e18;              ///< world units: squares and areas stay finite floats
inline constexpr float largest_texture_coordinate = 1e6F;       ///< beyond it floats cannot tell texels apart
inline constexpr std::uint64_t unstored_bytes = 16ULL << 20U;   ///< that any file may make out of nothing
inline constexpr std::uint64_t most_bytes_per_stored_byte = 1024;  ///< that geometry may take in memory

}  // namespace vmap::gltf
