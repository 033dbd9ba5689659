// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// KHR_draco_mesh_compression: triangles and vertices that libdraco unpacks.
#pragma once

#include "../file_bytes.h"
#include "accessor.h"
#include "buffers.h"
#include "document.h"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vmap::gltf {

/// A decompressed primitive.
struct DracoMesh {
    std::uint64_t vertex_count = 0;
    std::vector<std::uint32_t> indices;  ///< three per triangle, below vertex_count
    std::vector<std::pair<std::string, Elements>> attributes;
    std::vector<Bytes> storage;  ///< what the elements point into

    [[nodiscard]] const Elements* find(const std::string& attribute) const;
};

/// Decompresses a primitive.
///
/// - throws BrokenContent when the bytes are damaged or hold something else than the primitive's accessors say
[[nodiscard]] DracoMesh decode_draco(const Document& document, const Primitive& primitive, const DracoInfo& draco,
                                     Buffers& buffers);

}  // namespace vmap::gltf
