// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// glTF 2.0 files (.gltf and .glb).
///
/// Sources: the glTF 2.0 specification and the texts of the extensions that docs/inputs.md lists.
#pragma once

#include <vmap/importers/input.h>

#include <filesystem>

namespace vmap {

/// Reads one scene of a glTF file with everything that it needs: meshes at the pose of the file (no animation), points,
/// materials with decoded images, lights and cameras. docs/inputs.md says what is read, mapped, warned about or
/// refused.
///
/// The file is not trusted: it is checked before anything is allocated by its numbers, and only regular files inside
/// its own folder are opened.
///
/// Points come from primitives of mode POINTS: normals from NORMAL or _NORMAL, albedo from _ALBEDO or COLOR_0 (linear),
/// irradiance from _IRRADIANCE, emission from _EMISSION, areas from the accessor that the mesh's extras name as "areas"
/// or else from the extras' "radius". A file is ours when its generator is vmap, the extras of its asset hold what our
/// writer leaves there, and its points have normals, areas, albedo and irradiance.
///
/// - file: told apart by its content, not by its name
/// - throws FileError when it cannot be read or breaks the specification, UnsupportedInput when it needs an extension
///   that is not supported, exceeds a limit or holds no surface and no points, UsageError for a scene it does not have
[[nodiscard]] Input import_gltf(const std::filesystem::path& file, const InputConfig& config = {});

}  // namespace vmap
