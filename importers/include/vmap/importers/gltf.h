// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// glTF 2.0 files (.gltf and .glb) as a Scene.
///
/// Sources: the glTF 2.0 specification and the texts of the extensions that docs/inputs.md lists.
#pragma once

#include <vmap/light_units.h>
#include <vmap/scene.h>

#include <filesystem>
#include <optional>
#include <string>

namespace vmap {

struct GltfConfig {
    std::optional<std::string> scene;             ///< name or index; the file's default scene when empty
    LightUnits light_units = LightUnits::compat;  ///< what the numbers of the file's lights mean
};

/// Reads one scene of a glTF file with everything that it needs: meshes at the pose of the file (no animation), points,
/// materials with decoded images, lights and cameras. docs/inputs.md says what is read, mapped, warned about or refused.
///
/// The file is not trusted: it is checked before anything is allocated by its numbers, and only regular files inside its
/// own folder are opened.
///
/// - file: told apart by its content, not by its name
/// - throws FileError when it cannot be read or breaks the specification, UnsupportedInput when it needs an extension
///   that is not supported, exceeds a limit or holds no surface and no points, UsageError for a scene it does not have
[[nodiscard]] Scene import_gltf(const std::filesystem::path& file, const GltfConfig& config = {});

}  // namespace vmap
