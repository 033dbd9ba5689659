// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// EXT_meshopt_compression: views that are stored by meshoptimizer's codecs.
#pragma once

#include "../file_bytes.h"
#include "document.h"

#include <cstddef>
#include <span>

namespace vmap::gltf {

/// Decompresses a view and undoes its filter.
///
/// - view: the caller has agreed to the memory for count * stride bytes
/// - compressed: the bytes that the view names
/// - returns count * stride bytes
/// - throws BrokenContent when the bytes are damaged or the numbers do not suit the codec
[[nodiscard]] Bytes decompress_meshopt(const MeshoptView& view, std::span<const std::byte> compressed);

}  // namespace vmap::gltf
