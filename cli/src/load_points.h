// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The first half of every job: a file of any kind becomes a complete point cloud with its lights.
#pragma once

#include "job.h"
#include "raw_points.h"

#include <vmap/exporters/output_info.h>
#include <vmap/importers/input.h>
#include <vmap/importers/sample_surface.h>
#include <vmap/light_source.h>

#include <string>
#include <vector>

namespace vmap {

struct LoadOptions {
    std::string file;
    std::string scene;
    LightUnits light_units = LightUnits::compat;
    SampleConfig sample;
    std::vector<std::string> lights;  ///< --light, not yet parsed
    RawPointOptions raw;
};

/// --scene and --light-units.
void add_scene_options(CLI::App& app, std::string& scene, LightUnits& light_units);

[[nodiscard]] InputConfig input_config(const std::string& scene, LightUnits light_units);

void add_load_options(CLI::App& app, LoadOptions& options);

struct LoadedPoints {
    Scene scene;     ///< without instances when the file holds points only
    LitCloud cloud;  ///< complete points; irradiance only from our own lit files
    std::vector<LightSource> lights;
    OutputInfo info;  ///< source and light units
    double import_seconds = 0;
    double sample_seconds = 0;
};

/// Surface that the points stand for, world units squared.
[[nodiscard]] double total_area(const PointCloud& cloud);

/// - throws what read_input and sample_surface throw
[[nodiscard]] LoadedPoints load_points(const LoadOptions& options, Job& job);

}  // namespace vmap
