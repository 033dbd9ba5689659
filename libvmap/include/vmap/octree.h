// SPDX-License-Identifier: Apache-2.0
/// \file
/// Octrees over the points of a cloud, adaptive and uniform, the two trees of the seed.
///
/// Points are first parted by the dominant axis of their normal, six classes that share one grid of cells, then by
/// cell, and a cell whose points lie on several parallel sheets is parted by sheet. A leaf is therefore the part of one
/// surface in one cell, and its averaged normal means something even in corners, thin walls and under lamps.
///
/// This work is based on:
///   R. Goradia, A. Kanakanti, S. Chandran, A. Datta, "Visibility map for global illumination in point clouds",
///   GRAPHITE 2007 (uniform and adaptive octree, centroid, averaged normal, R);
///   G. M. Morton, "A computer oriented geodetic data base", IBM 1966 (order of the cells).
#pragma once

#include <vmap/point_cloud.h>
#include <vmap/tree.h>

#include <cstddef>
#include <cstdint>

namespace vmap {

enum class OctreeKind {
    adaptive,  ///< a cell is split while it holds more than points_per_leaf points and is larger than cell_size
    uniform    ///< every leaf lies in a cell of cell_size
};

struct OctreeConfig {
    OctreeKind kind = OctreeKind::adaptive;
    double cell_size = 0;  ///< edge of the smallest cells, world units; 0: as small as it takes (adaptive only)
    std::uint32_t points_per_leaf = 64;  ///< adaptive only; 0 splits down to cell_size everywhere
};

/// Levels of cells below the root at most; a uniform octree has no more than 1024 cells along an axis.
inline constexpr int max_octree_levels = 20;
inline constexpr int max_uniform_levels = 10;

/// Splits the cloud. Every point is in exactly one leaf; no node has a single child. A leaf's R is the largest distance
/// of its points from the centroid within the tangent plane, plus half the diagonal of a square of the leaf's mean
/// point spacing: the disc then covers the surface between its points and that of the next leaf, not only the points.
/// The result is the same bit for bit at any number of threads.
///
/// - throws UnsupportedInput when a position or normal is not finite; UsageError for a uniform octree with a cell size
///   of 0 or below 1/1024 of the cloud's extent, for a negative cell size, and for an adaptive one with neither limit
[[nodiscard]] Tree build_octree(const PointCloud& cloud, const OctreeConfig& config = {});

/// The cell size with which an octree of this kind comes closest to a wanted number of leaves. Costs about thirty
/// octrees.
///
/// - leaves: at least 1; a cloud may be unable to give so many or so few, then the nearest that it can give
[[nodiscard]] OctreeConfig octree_config_for_leaves(const PointCloud& cloud, OctreeKind kind, std::size_t leaves);

}  // namespace vmap
