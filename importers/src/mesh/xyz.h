// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// XYZ files: one point a line.
#pragma once

#include "mesh_file.h"

#include <string_view>

namespace vmap {

/// Reads three coordinates a line, then optionally a normal or a colour or both, in either order. Which one it is says
/// the file: three numbers that are whole and up to 255 in all lines, not all of them of length one, are a colour;
/// three numbers of length one in all lines are a normal. A single number between coordinates and these, such as an
/// intensity, is passed over.
///
/// - text: of the whole file; a line with the number of points may come first; '#' starts a comment
/// - throws BrokenContent
[[nodiscard]] MeshFile read_xyz(std::string_view text);

}  // namespace vmap
