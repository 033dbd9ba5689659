// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Any file that the toolkit reads, told apart by its content.
#pragma once

#include <vmap/light_units.h>
#include <vmap/point_cloud.h>
#include <vmap/scene.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vmap {

struct InputConfig {
    std::optional<std::string> scene;             ///< glTF: name or index of the scene; the file's default when empty
    LightUnits light_units = LightUnits::compat;  ///< glTF: what the numbers of the file's lights mean
};

/// Points that a file holds as they are in the file, in the world frame of axes.h.
struct PointFile {
    LitCloud cloud;     ///< arrays that the file has no data for are empty: normals, areas, albedo, irradiance, ...
    bool ours = false;  ///< written by this toolkit: complete, and irradiance is kept
    LightUnits light_units = LightUnits::compat;  ///< of our own files
    double exposure = 1;                          ///< of our own files
    std::string source;                           ///< of our own files: what the points were sampled from
};

/// What one file holds: meshes, points or both.
struct Input {
    Scene scene;  ///< lights, cameras, warnings and extensions too; without instances for a file of points
    std::optional<PointFile> points;
};

/// Reads glTF/GLB, OBJ, PLY, OFF, STL and XYZ. docs/inputs.md says what is read, mapped, warned about or refused.
///
/// - throws FileError for a file that cannot be read or is broken, UnsupportedInput for one that asks for what is not
///   supported or holds neither surface nor points, UsageError for a scene that the file does not have
[[nodiscard]] Input read_input(const std::filesystem::path& file, const InputConfig& config = {});

}  // namespace vmap
