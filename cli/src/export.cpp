// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// vmap export: scenes and lit points for other programs.
#include "choice.h"
#include "commands.h"
#include "distinct_files.h"
#include "load_points.h"
#include "outputs.h"
#include "raw_points.h"

#include <vmap/error.h>
#include <vmap/exporters/camera_placement.h>
#include <vmap/exporters/pov_points.h>
#include <vmap/exporters/pov_scene.h>
#include <vmap/printable.h>

#include <fmt/format.h>

#include <map>

namespace vmap {
namespace {

struct ExportOptions {
    std::string file;
    std::string scene;
    LightUnits light_units = LightUnits::compat;
    std::string output;
    UpAxis up = UpAxis::y;
    std::string size = "512";
    RawPointOptions raw;
    std::string camera;
    PovPreset preset = PovPreset::normal;
    std::optional<int> bounces;
};

void export_scene(const ExportOptions& options, const Input& input, Job& job) {
    PovConfig config;
    config.preset = options.preset;
    config.bounces = options.bounces;
    config.camera = choose_camera(input.scene, bounds_of(input.scene), options.camera, job);
    std::tie(config.width, config.height) = parse_size(options.size, config.camera->aspect);
    const OutputInfo info{
        .up = options.up, .light_units = options.light_units, .exposure = 1, .source = input.scene.source};
    const auto lock = job.interruption().hold_off();
    const PovExport made = write_pov_scene(input.scene, options.output, info, config);
    job.warn(made.warnings);
    for (const std::string& file : made.files) job.tell("wrote " + file);
}

void export_points(const ExportOptions& options, const PointFile& points, const Scene& scene, Job& job) {
    PovPointsConfig config;
    config.camera = choose_camera(scene, bounds_of(points.cloud.points), options.camera, job);
    std::tie(config.width, config.height) = parse_size(options.size, config.camera->aspect);
    const OutputInfo info{
        .up = options.up, .light_units = points.light_units, .exposure = points.exposure, .source = points.source};
    FileWriter file(options.output);
    write_pov_points(file, points.cloud, info, config, job.progress());
    file.finish();
    const auto lock = job.interruption().hold_off();
    file.commit();
}

void run_export(const ExportOptions& options, Job& job) {
    if (!options.output.ends_with(".pov"))
        throw UsageError(options.output +
                         ": expected a name that ends in .pov (vmap light and vmap sample write .ply, "
                         ".glb, .gltf, .vdb, .exr and .png)");
    require_distinct_files({options.file}, {options.output});
    Input input = read_input(options.file, input_config(options.scene, options.light_units));
    job.warn(input.scene.warnings);
    if (!input.scene.instances.empty())
        export_scene(options, input, job);
    else if (input.points) {
        const Scene scene = std::move(input.scene);
        export_points(options, complete_points(std::move(input), options.file, options.raw, scene.lights, job), scene,
                      job);
    } else
        throw UnsupportedInput(options.file + ": nothing to export; expected meshes or points");
}

}  // namespace

Command add_export_command(CLI::App& program) {
    CLI::App* app = program.add_subcommand("export", "Writes a scene, or lit points, for POV-Ray");
    app->footer("Example: vmap export room.glb -o room.pov && povray +Iroom.pov +Oroom.exr");
    auto options = std::make_shared<ExportOptions>();
    app->add_option("FILE", options->file, "A scene, or points with light")->required();
    app->add_option("-o,--output", options->output, "The .pov file; images are written beside it")
        ->required()
        ->type_name("FILE");
    add_scene_options(*app, options->scene, options->light_units);
    app->add_option("--up", options->up, "Axis that is up in the file")
        ->transform(choice(std::map<std::string, UpAxis>{{"y", UpAxis::y}, {"z", UpAxis::z}}))
        ->type_name("y|z")
        ->default_str("y");
    app->add_option("--preset", options->preset, "How much work POV-Ray's radiosity does")
        ->transform(choice(std::map<std::string, PovPreset>{
            {"draft", PovPreset::draft}, {"normal", PovPreset::normal}, {"reference", PovPreset::reference}}))
        ->type_name("draft|normal|reference")
        ->default_str("normal");
    app->add_option("--bounces", options->bounces, "Reflections that count, 0 to 20; default: by the preset")
        ->type_name("N");
    app->add_option("--size", options->size, "Of the picture: WIDTHxHEIGHT, or the height alone")
        ->type_name("SIZE")
        ->default_str("512");
    app->add_option("--camera", options->camera, "Camera of the scene, by name or index")->type_name("NAME");
    add_raw_point_options(*app, options->raw);
    return {app, [options](Job& job) { run_export(*options, job); }};
}

}  // namespace vmap
