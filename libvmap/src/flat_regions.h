// SPDX-License-Identifier: Apache-2.0
/// \file
/// Planes that hold many points of a cloud, found top down: a cell of the cloud whose points lie on one plane is a
/// seed, seeds of the same plane are merged, and points of mixed cells join the planes they lie on.
///
/// This work is based on:
///   F. A. Limberger, M. M. Oliveira, "Real-time detection of planar regions in unorganized point clouds", 2015.
#pragma once

#include <vmap/point_cloud.h>

#include <cstdint>
#include <span>
#include <vector>

namespace vmap {

/// Points on one plane, not necessarily connected.
struct FlatRegion {
    Imath::V3d center{0, 0, 0};
    Imath::V3d normal{0, 0, 1};
    std::vector<std::uint32_t> points;
};

struct FlatRegions {
    std::vector<FlatRegion> regions;
    std::vector<std::uint32_t> rest;  ///< points on no plane
};

/// - points: indices into the cloud, the ones to look at; reordered
/// - spacing: mean distance of neighbouring points, world units
[[nodiscard]] FlatRegions find_flat_regions(const PointCloud& cloud, std::span<std::uint32_t> points, double spacing);

}  // namespace vmap
