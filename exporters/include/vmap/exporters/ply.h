// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Lit points as a binary little-endian PLY file.
#pragma once

#include <vmap/exporters/file_writer.h>
#include <vmap/exporters/output_info.h>
#include <vmap/point_cloud.h>
#include <vmap/progress.h>

namespace vmap {

/// Writes one vertex per point:
///   float x y z nx ny nz               position minus the header's offset, normal
///   uchar red green blue               sRGB of exposure x radiance, for display only
///   float irradiance_r irradiance_g irradiance_b     W/m^2, linear
///   float albedo_r albedo_g albedo_b
///   float radius area                  world units, world units squared
///   uint face_id material_id           in the order of the source; 0 where the cloud has none
///   float emission_r emission_g emission_b           W/(m^2 sr); only when something emits
///
/// The comments of the header hold `up`, `light_units` with the factor of point and spot lights and the factor of
/// directional ones, `offset` (doubles, to be added to x y z in the axes of the file; 0 unless floats would cost more
/// than a hundredth of the spacing), `exposure`, `vmap` with the version, and `source`.
///
/// A cloud without irradiance has no such properties, and its colours are sRGB of the albedo.
/// Needs no memory that grows with the cloud. Throws FileError; the caller commits the file.
void write_ply(FileWriter& file, const LitCloud& cloud, const OutputInfo& info, const ProgressCallback& progress = {});

}  // namespace vmap
