// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Lit points as an OpenVDB points file.
#pragma once

#include <vmap/exporters/file_writer.h>
#include <vmap/exporters/output_info.h>
#include <vmap/point_cloud.h>
#include <vmap/progress.h>

namespace vmap {

/// Writes one point data grid `points` with the attributes, all uncompressed floats:
///   P           position; the grid's transform holds the offset of a cloud far from the world's origin
///   N           normal
///   Cd          radiance, linear, neither exposed nor clamped; the albedo of a cloud without light
///   pscale      radius in world units
///   irradiance  W/m^2, linear; absent in a cloud without light
///   albedo
///
/// The metadata is that of write_vdb_grid. Equal clouds give equal bytes at any number of threads.
/// Throws FileError; the caller commits the file.
void write_vdb_points(FileWriter& file, const LitCloud& cloud, const OutputInfo& info,
                      const ProgressCallback& progress = {});

}  // namespace vmap
