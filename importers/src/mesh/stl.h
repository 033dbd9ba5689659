// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// STL files, text and binary.
///
/// Source: 3D Systems, "Stereolithography interface specification", 1989.
#pragma once

#include "mesh_file.h"

#include <cstdint>
#include <string_view>

namespace vmap {

/// Whether the size of the file is the one that its number of triangles asks for. Headers of binary files may start
/// with "solid" like those of text files; the size tells them apart.
/// - start: of the file, at least 84 bytes if it has them; size: of the whole file
[[nodiscard]] bool is_binary_stl(std::string_view start, std::uint64_t size);

/// Vertices at the same position become one. Normals of facets are not read: the winding says more.
/// - text: of the whole file
/// - throws BrokenContent
[[nodiscard]] MeshFile read_stl(std::string_view text);

}  // namespace vmap
