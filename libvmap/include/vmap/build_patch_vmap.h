// SPDX-License-Identifier: Apache-2.0
/// \file
/// Builds the visibility map of a patch tree under the rule `patch` (see patch_visibility.h). Three methods give one
/// answer, equal to the last link.
///
/// Every builder goes down through the same pairs of nodes. A pair is decided at the first level at which it can be:
/// visible when its shaft is free, invisible when nothing faces or one patch cuts the whole shaft. Nodes above patches
/// are decided by facing alone. A pair whose parts all came out alike comes out like them.
#pragma once

#include <vmap/build_vmap.h>
#include <vmap/patch.h>
#include <vmap/point_cloud.h>
#include <vmap/progress.h>
#include <vmap/tree.h>
#include <vmap/visibility_map.h>

#include <cstdint>

namespace vmap {

struct PatchVmapConfig {
    VmapMethod method = VmapMethod::fast;

    /// A pair that faces wholly and whose shaft no more than so many patches enter is left partial rather than split
    /// further: a segment against so few patches is soon tested, while links along the edges of shadows are many. 0:
    /// pairs are split down to the leaves, and each visible pair of leaves is under a link.
    std::uint32_t few_patches = 0;
};

/// Links of the rule `patch`.
///
/// - cloud: with areas
/// - tree: as build_patch_tree made it of cloud and set
[[nodiscard]] VisibilityMap build_patch_vmap(const PointCloud& cloud, const Tree& tree, const PatchSet& set,
                                             const PatchVmapConfig& config = {}, const ProgressCallback& progress = {});

}  // namespace vmap
