// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// EXT_mesh_gpu_instancing: one node that shows its mesh many times.
#pragma once

#include "buffers.h"
#include "document.h"

#include <Imath/ImathMatrix.h>

#include <vector>

namespace vmap::gltf {

/// world_from_mesh of each instance.
///
/// - throws BrokenContent when the accessors do not suit, UnsupportedContent for more instances than the limit
[[nodiscard]] std::vector<Imath::M44d> instance_matrices(const Document& document, const InstancingInfo& instancing,
                                                         const Imath::M44d& world_from_node, Buffers& buffers);

}  // namespace vmap::gltf
