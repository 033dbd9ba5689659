// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The sizes that a Draco bitstream claims, read before libdraco takes memory for them.
///
/// Source: the Draco bitstream specification, version 2.2.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace vmap::gltf {

struct DracoSizes {
    std::uint64_t faces = 0;
    std::uint64_t points = 0;  ///< at most
};

/// - throws BrokenContent when the bytes are not the start of a triangle mesh, UnsupportedContent for versions of the
///   bitstream that glTF does not use
[[nodiscard]] DracoSizes read_draco_sizes(std::span<const std::byte> bytes);

}  // namespace vmap::gltf
