// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Everything in a POV-Ray scene but its surfaces: header, global settings, sky, camera, lights.
#pragma once

#include "pov_frame.h"
#include "pov_text.h"

#include <vmap/exporters/pov_scene.h>

#include <span>
#include <string>

namespace vmap {

/// Throws UsageError for settings out of range; path names the file.
void check_config(const PovConfig& config, const std::string& path);

/// File names that no shell, no string of POV-Ray's and no file system takes amiss: everything but ASCII letters,
/// digits, dots and hyphens becomes an underscore.
[[nodiscard]] std::string plain_name(const std::string& name);

/// The name of a .pov file, without its folder, as one word of a command line.
[[nodiscard]] std::string pov_command_name(const std::string& path);

/// The picture that the header's command makes of a file.
[[nodiscard]] std::string pov_picture_name(const std::string& path);

/// Axes, light units and scale, as comments.
void write_conventions(PovText& text, const OutputInfo& info, const PovFrame& frame);

void write_header(PovText& text, const std::string& path, const OutputInfo& info, const PovConfig& config,
                  const PovFrame& frame);

/// Version, units of colour, radiosity.
void write_globals(PovText& text, const PovConfig& config);

/// - sky_file: name of the sky's image; empty: the constant sky
void write_sky(PovText& text, const PovConfig& config, const PovFrame& frame, const std::string& sky_file);

/// Throws UnsupportedInput for numbers that are not finite; path names the file.
void write_lights(PovText& text, std::span<const LightSource> lights, const PovFrame& frame, const std::string& path);

}  // namespace vmap
