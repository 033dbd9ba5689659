// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Raw points, such as scans, made ready for light: normals, sides and areas that the file does not have.
///
/// This work is based on:
///   H. Hoppe et al., "Surface reconstruction from unorganized points", SIGGRAPH 1992 (normals and the spanning tree
///   that carries their sides from point to point);
///   H. Xie et al., "Piecewise C1 continuous surface reconstruction of noisy point clouds via local implicit quadric
///   regression", IEEE Visualization 2003 (the mirrored normal that goes around creases rightly).
#pragma once

#include <vmap/light_source.h>
#include <vmap/point_cloud.h>
#include <vmap/progress.h>

#include <Imath/ImathVec.h>

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace vmap {

/// Which side of a surface estimated normals are to face.
enum class CloudSide {
    automatic,  ///< inward for what surrounds a light or looks like a furnished room, else outward
    topmost,    ///< in each connected piece the topmost point looks up, as CGAL's mst_orient_normals does
    inward,     ///< as in a room; smaller pieces in it face outward
    outward     ///< as of an object
};

struct PrepareConfig {
    CloudSide side = CloudSide::automatic;
    std::optional<Imath::V3d> viewpoint;  ///< all normals face it, whatever the side; world
    std::span<const LightSource> lights;  ///< tell CloudSide::automatic where the lit side is
};

struct PrepareReport {
    std::size_t duplicates = 0;         ///< points in the place of another one, dropped
    std::size_t outliers = 0;           ///< points far from all others, dropped
    double spacing = 0;                 ///< mean distance of neighbours, world units
    double noise = 0;                   ///< deviation of the points from a smooth surface, where normals were estimated
    double area = 0;                    ///< sum of the areas, world units squared
    std::vector<std::string> warnings;  ///< what was assumed, one line each
};

/// Whether a cloud has all that light needs, so that prepare_cloud leaves it as it is.
[[nodiscard]] bool is_complete(const PointCloud& cloud);

/// Fills in what a cloud lacks. Normals are those of planes through the nearest points, one side of a crease at a time.
/// Areas are those of Voronoi cells in the tangent planes; at open borders a cell ends a quarter of the spacing from
/// its point. A missing albedo is 0.8. Points in the place of another one and outliers (more than three times as far
/// from their neighbours as those are from theirs) are dropped, also from the irradiance. What the cloud has stays as
/// it is. The result is the same bit for bit at any number of threads.
///
/// - cloud: finite, normals of unit length, world frame
/// - throws UnsupportedInput for points that are no surface: fewer than three places, or all on one line
void prepare_cloud(LitCloud& cloud, const PrepareConfig& config = {}, PrepareReport* report = nullptr,
                   const ProgressCallback& progress = {});

}  // namespace vmap
