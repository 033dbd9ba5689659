// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The two forms of a glTF file, told apart by the first four bytes: JSON text alone, or a GLB container of chunks.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

namespace vmap::gltf {

/// Parts of a file in memory; they point into its bytes.
struct Container {
    std::string_view json;                          ///< the document
    std::optional<std::span<const std::byte>> bin;  ///< the GLB's binary chunk, padding included
    bool is_glb = false;
};

/// Splits a file after checking every length that it claims.
///
/// - throws BrokenContent for an empty file or a GLB whose header or chunks do not fit it
[[nodiscard]] Container open_container(std::span<const std::byte> file);

}  // namespace vmap::gltf
