// SPDX-License-Identifier: Apache-2.0
/// \file
/// Builds the visibility map of a tree. Three methods give one answer, equal to the last link.
///
/// This work is based on:
///   R. Goradia, A. Kanakanti, S. Chandran, A. Datta, "Visibility map for global illumination in point clouds",
///   GRAPHITE 2007 (OctreeVisibility, NodeToNodeVisibility);
///   E. Haines, J. Wallace, "Shaft culling for efficient ray-traced radiosity", EGWR 1991 (the fast method).
#pragma once

#include <vmap/progress.h>
#include <vmap/tree.h>
#include <vmap/visibility_map.h>

namespace vmap {

enum class VmapMethod {
    exhaustive,  ///< every pair of leaves on its own, then merged: the oracle. Memory: leaves squared / 8 bytes
    seed,        ///< the seed's recursion over old and new interaction lists, one thread
    fast         ///< down from pairs of large nodes with the few occluders that reach between them
};

/// Links of the rule `centroid`.
///
/// - tree: an octree; links are between its nodes
[[nodiscard]] VisibilityMap build_vmap(const Tree& tree, VmapMethod method = VmapMethod::fast,
                                       const ProgressCallback& progress = {});

}  // namespace vmap
