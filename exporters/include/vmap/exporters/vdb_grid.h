// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The light of a point cloud as voxel grids in an OpenVDB file.
#pragma once

#include <vmap/exporters/file_writer.h>
#include <vmap/exporters/output_info.h>
#include <vmap/point_cloud.h>
#include <vmap/progress.h>

namespace vmap {

struct VdbGridConfig {
    double voxel_size = 0;  ///< edge of a voxel, world units; 0: default_voxel_size() of the cloud
};

/// Twice the mean spacing of the points, so that a surface leaves no holes; 1 for fewer than two points.
[[nodiscard]] double default_voxel_size(const PointCloud& cloud);

/// Writes two grids of one transform:
///   density     float fog volume: 1 in the voxels that hold points, 0 elsewhere
///   irradiance  Vec3S, invariant under transforms: area mean of E over a voxel's points [W/m^2], both sides of a sheet
///               together, and continued over two voxels around them by the mean of their neighbours, so that
///               interpolation at the surface does not darken it; absent in a cloud without light
///
/// World positions are those of the other formats in the same axes: the transform holds the voxel size and the offset
/// of a cloud far from the world's origin. Each grid has name, class and creator, and as metadata up, light_units with
/// its two factors, exposure, offset, source and units. There is at least one leaf node even in an empty cloud.
///
/// Equal clouds give equal bytes at any number of threads (the file's UUID comes from its content).
/// Throws FileError, UsageError for a voxel size that is not positive or below an eighth of the mean spacing; the
/// caller commits the file.
void write_vdb_grid(FileWriter& file, const LitCloud& cloud, const OutputInfo& info, const VdbGridConfig& config = {},
                    const ProgressCallback& progress = {});

}  // namespace vmap
