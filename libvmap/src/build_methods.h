// SPDX-License-Identifier: Apache-2.0
/// \file
/// The methods behind build_vmap, one per source file.
#pragma once

#include <vmap/build_patch_vmap.h>
#include <vmap/progress.h>
#include <vmap/tree.h>
#include <vmap/visibility_map.h>

namespace vmap {

[[nodiscard]] VisibilityMap build_exhaustive(const Tree& tree, const ProgressCallback& progress);
[[nodiscard]] VisibilityMap build_as_seed(const Tree& tree, const ProgressCallback& progress);
[[nodiscard]] VisibilityMap build_fast(const Tree& tree, const ProgressCallback& progress);
[[nodiscard]] VisibilityMap build_patch_fast(const PointCloud& cloud, const Tree& tree, const PatchSet& set,
                                             const PatchVmapConfig& config, const ProgressCallback& progress);

}  // namespace vmap
