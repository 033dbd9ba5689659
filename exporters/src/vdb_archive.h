// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// OpenVDB files through our writer; the library's own reports success on a full disk.
#pragma once

#include <vmap/exporters/file_writer.h>
#include <vmap/exporters/output_info.h>
#include <vmap/point_cloud.h>

#include <openvdb/openvdb.h>

#include <string>

namespace vmap {

/// The transform of a grid in the axes of a file: voxels of this size, centred on multiples of it from the offset.
[[nodiscard]] openvdb::math::Transform::Ptr voxel_transform(double voxel_size, const Imath::V3d& file_offset);

/// Adds name, class, creator and the metadata that all our grids have. Call it last.
void describe_grid(openvdb::GridBase& grid, const std::string& name, const OutputInfo& info,
                   const Imath::V3d& file_offset);

/// Writes the grids with a UUID that depends on the cloud, the info and the kind only.
/// - kind: any text that tells files of one cloud apart
void write_vdb(FileWriter& file, const openvdb::GridCPtrVec& grids, const LitCloud& cloud, const OutputInfo& info,
               const std::string& kind);

}  // namespace vmap
