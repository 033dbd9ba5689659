// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Lit points as a glTF 2.0 file with one primitive of mode POINTS.
#pragma once

#include <vmap/exporters/file_writer.h>
#include <vmap/exporters/output_info.h>
#include <vmap/point_cloud.h>
#include <vmap/progress.h>

namespace vmap {

enum class GltfContainer {
    binary,   ///< .glb
    embedded  ///< .gltf: JSON with the data in base64
};

struct GltfPointsConfig {
    GltfContainer container = GltfContainer::binary;
    bool normals = false;  ///< also as NORMAL, which makes viewers light the points once more
};

/// Writes one vertex per point, every attribute a VEC3 of floats (Blender 4.2 to 5.0 fails on custom attributes of
/// different widths):
///   POSITION     relative to the node's translation, which is the offset of a cloud far from the world's origin
///   COLOR_0      exposure x radiance, linear, clamped to [0, 1]; the albedo of a cloud without light
///   _IRRADIANCE  W/m^2, linear; absent in a cloud without light
///   _ALBEDO, _NORMAL
///   _EMISSION    W/(m^2 sr), linear; only when something emits
///
/// `mesh.extras.radius` is the mean radius of a point in world units, `mesh.extras.areas` an accessor of scalars that
/// holds the area of each point in world units squared; it is no attribute. `asset.extras` holds up, light_units with
/// the two factors, exposure and source. The material is unlit, since the colours are light already.
///
/// A cloud without points gives a valid file with an empty scene. Needs no memory that grows with the cloud.
/// Throws FileError, and UnsupportedInput when the data exceeds the 4 GiB of a .glb; the caller commits the file.
void write_gltf_points(FileWriter& file, const LitCloud& cloud, const OutputInfo& info,
                       const GltfPointsConfig& config = {}, const ProgressCallback& progress = {});

}  // namespace vmap
