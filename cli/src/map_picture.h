// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Colours of the points of a visibility map: the seed's pictures of what one point sees, of umbras and of leaves.
#pragma once

#include <vmap/vmap_file.h>

#include <Imath/ImathColor.h>
#include <Imath/ImathVec.h>

#include <vector>

namespace vmap {

/// Light where a point sees the point next to `from`, dark where it does not, that point's surroundings red.
[[nodiscard]] std::vector<Imath::C3f> paint_visibility(const VmapContents& contents, const Imath::V3d& from);

/// Dark in the umbra of all lights, light where all of them reach.
[[nodiscard]] std::vector<Imath::C3f> paint_umbra(const VmapContents& contents);

/// A colour for each leaf.
[[nodiscard]] std::vector<Imath::C3f> paint_leaves(const VmapContents& contents);

}  // namespace vmap
