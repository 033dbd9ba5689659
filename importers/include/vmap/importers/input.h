// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Any file that the toolkit reads, told apart by its content.
#pragma once

#include <vmap/axes.h>
#include <vmap/light_units.h>
#include <vmap/point_cloud.h>
#include <vmap/scene.h>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vmap {

struct InputConfig {
    std::optional<std::string> scene;             ///< glTF: name or index of the scene; the file's default when empty
    LightUnits light_units = LightUnits::compat;  ///< glTF: what the numbers of the file's lights mean
    /// Axis that is up in a file that does not say so. When empty, y for OBJ and z for PLY, OFF, STL and XYZ, so that
    /// Blender, which does not turn PLY files, shows an outgoing PLY file where it shows the incoming one.
    std::optional<UpAxis> up;
};

/// Points that a file holds as they are in the file, in the world frame of axes.h.
struct PointFile {
    LitCloud cloud;     ///< arrays that the file has no data for are empty: normals, areas, albedo, irradiance, ...
    bool ours = false;  ///< written by this toolkit: complete, and irradiance is kept
    LightUnits light_units = LightUnits::compat;  ///< of our own files
    double exposure = 1;                          ///< of our own files
    std::string source;                           ///< of our own files: what the points were sampled from
};

/// What a file says of itself, in its own terms.
struct InputFacts {
    std::string format;        ///< for people: "PLY, binary little-endian"
    UpAxis up = UpAxis::y;     ///< axes of the file; world_from_file(up, v) is a vector of the file in the world
    std::size_t vertices = 0;  ///< that the file counts; glTF: of the meshes that are used, each once
    std::size_t polygons = 0;  ///< that the file counts, before triangulation; triangle strips are none
};

/// What one file holds: meshes, points or both.
struct Input {
    InputFacts facts;
    Scene scene;  ///< lights, cameras, warnings and extensions too; without instances for a file of points
    std::optional<PointFile> points;
};

/// Reads glTF/GLB, OBJ, PLY, OFF, STL, XYZ and our own .vmap. The format is told by the content; a file whose name says
/// another one is refused. docs/inputs.md says what is read, mapped, warned about or refused.
///
/// - throws FileError for a file that cannot be read or is broken, UnsupportedInput for one that asks for what is not
///   supported or holds neither surface nor points, UsageError for a scene that the file does not have
[[nodiscard]] Input read_input(const std::filesystem::path& file, const InputConfig& config = {});

}  // namespace vmap
