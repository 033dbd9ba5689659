// SPDX-License-Identifier: GPL-3.0-or-later
#include "load_points.h"

#include "choice.h"
#include "parse_values.h"
#include "stopwatch.h"

#include <vmap/axes.h>
#include <vmap/error.h>

#include <map>

namespace vmap {
namespace {

/// A light of the command line, which is given in the axes of the file.
LightSource world_light(const std::string& text, UpAxis up) {
    LightSource light = parse_light(text);
    light.position = world_from_file(up, light.position);
    light.direction = world_from_file(up, light.direction);
    return light;
}

}  // namespace

void add_scene_options(CLI::App& app, std::string& scene, LightUnits& light_units) {
    app.add_option("--scene", scene, "glTF: the scene to read, by name or index")->type_name("NAME");
    app.add_option("--light-units", light_units,
                   "glTF: what the numbers of lights mean: compat (W/sr and W/m^2 as they stand), spec (photometric), "
                   "raw (Blender's watts)")
        ->transform(choice(std::map<std::string, LightUnits>{
            {"compat", LightUnits::compat}, {"spec", LightUnits::spec}, {"raw", LightUnits::raw}}))
        ->type_name("compat|spec|raw")
        ->default_str("compat");
}

InputConfig input_config(const std::string& scene, LightUnits light_units) {
    return {
        .scene = scene.empty() ? std::optional<std::string>() : scene, .light_units = light_units, .up = std::nullopt};
}

void add_load_options(CLI::App& app, LoadOptions& options) {
    app.add_option("FILE", options.file, "glTF, GLB, OBJ, PLY, OFF, STL or XYZ file")->required();
    add_scene_options(app, options.scene, options.light_units);
    auto* points = app.add_option("--points", options.sample.points, "Points to sample from the surface")
                       ->check(CLI::Validator(  // the parser would take -1 for 2^64 - 1
                           [](const std::string& text) {
                               return text.starts_with('-') ? "expected 1 or more, not " + text : std::string();
                           },
                           ""))
                       ->type_name("N");
    app.add_option("--spacing", options.sample.spacing, "Mean distance of points instead, world units")
        ->excludes(points)
        ->type_name("S");
    app.add_option("--pattern", options.sample.pattern, "How points are spread")
        ->transform(choice(std::map<std::string, SamplePattern>{{"blue-noise", SamplePattern::blue_noise},
                                                                {"stratified", SamplePattern::stratified}}))
        ->type_name("blue-noise|stratified")
        ->default_str("blue-noise");
    app.add_option("--normals", options.sample.normals, "Normals that irradiance is defined over")
        ->transform(choice(std::map<std::string, SampleNormals>{{"geometric", SampleNormals::geometric},
                                                                {"shading", SampleNormals::shading}}))
        ->type_name("geometric|shading")
        ->default_str("geometric");
    app.add_option("--sides", options.sample.sides, "Sides of the surface that get points")
        ->transform(choice(std::map<std::string, SampleSides>{
            {"auto", SampleSides::automatic}, {"front", SampleSides::front}, {"both", SampleSides::both}}))
        ->type_name("auto|front|both")
        ->default_str("auto");
    app.add_option("--light", options.lights,
                   "Adds a light: point:X,Y,Z:W_PER_SR or sun:DX,DY,DZ:W_PER_M2, in the axes of the file; may repeat")
        ->type_name("LIGHT");
    add_raw_point_options(app, options.raw);
}

double total_area(const PointCloud& cloud) {
    double area = 0;
    for (const float a : cloud.areas) area += static_cast<double>(a);
    return area;
}

LoadedPoints load_points(const LoadOptions& options, Job& job) {
    LoadedPoints loaded;
    for (const std::string& light : options.lights) static_cast<void>(parse_light(light));  // before the long work

    Stopwatch importing;
    const ProgressCallback progress = job.progress();
    report_progress(progress, "import", 0);
    Input input = read_input(options.file, input_config(options.scene, options.light_units));
    loaded.scene = std::move(input.scene);
    job.warn(loaded.scene.warnings);
    for (const std::string& light : options.lights) loaded.lights.push_back(world_light(light, input.facts.up));
    loaded.lights.insert(loaded.lights.end(), loaded.scene.lights.begin(), loaded.scene.lights.end());
    loaded.info.light_units = options.light_units;
    loaded.info.source = loaded.scene.source;
    loaded.import_seconds = importing.seconds();

    if (loaded.scene.instances.empty() && input.points) {
        if (options.sample.points || options.sample.spacing)
            job.warn("the file holds points, which are taken as they are: --points and --spacing do nothing");
        Stopwatch preparing;
        PointFile points = complete_points(std::move(input), options.file, options.raw, loaded.lights, job);
        if (points.ours) {
            loaded.info.light_units = points.light_units;
            loaded.info.source = points.source;
        }
        loaded.cloud = std::move(points.cloud);
        loaded.sample_seconds = preparing.seconds();
        return loaded;
    }
    Stopwatch sampling;
    SampleConfig sample = options.sample;
    sample.seed = job.options().seed;
    SampleReport report;
    try {
        loaded.cloud.points = sample_surface(loaded.scene, sample, progress, &report);
    } catch (const UsageError& error) {
        throw UsageError(options.file + ": " + error.what());
    }
    job.warn(report.warnings);
    loaded.sample_seconds = sampling.seconds();
    return loaded;
}

}  // namespace vmap
