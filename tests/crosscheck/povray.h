// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Pictures by POV-Ray of our exports, kept by the content of what went in.
#pragma once

#include <vmap/exporters/picture.h>
#include <vmap/exporters/pov_scene.h>
#include <vmap/scene.h>

#include <filesystem>
#include <string>

namespace vmap::crosscheck {

/// Version that povray says it has, as in "3.7.0.10.unofficial"; empty where it is missing.
[[nodiscard]] std::string povray_version();

struct PovPicture {
    Picture picture;
    std::string options;  ///< what povray was called with
    double seconds = 0;   ///< of processor time that povray took when the picture was made
    bool kept = false;    ///< from an earlier run
};

/// Exports the scene and renders it with one thread and without antialiasing: a pixel is what its middle sees.
///
/// - cache: folder that keeps pictures under a hash of all exported files, the options and povray's version
/// - throws std::runtime_error with povray's words when it fails
[[nodiscard]] PovPicture render_by_povray(const Scene& scene, const PovConfig& config,
                                          const std::filesystem::path& cache);

}  // namespace vmap::crosscheck
