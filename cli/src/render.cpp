// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// vmap render: a picture of lit points.
#include "choice.h"
#include "commands.h"
#include "distinct_files.h"
#include "load_points.h"
#include "outputs.h"
#include "parse_values.h"

#include <vmap/error.h>
#include <vmap/exporters/camera_placement.h>
#include <vmap/exporters/exr.h>
#include <vmap/exporters/png.h>
#include <vmap/exporters/render_picture.h>
#include <vmap/printable.h>

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <numbers>

namespace vmap {
namespace {

struct RenderOptions {
    std::string points;
    std::string camera;
    std::string scene;
    std::vector<std::string> outputs;
    std::string size = "512";
    std::optional<double> exposure;
    PictureContent content = PictureContent::radiance;
};

/// A camera at X,Y,Z that looks at TX,TY,TZ with a vertical field of view in degrees, +Y up in the world.
Camera camera_from_numbers(const std::string& text) {
    const std::vector<double> n = parse_numbers("--camera", text, 7, 7);
    const Imath::V3d from(n[0], n[1], n[2]);
    const Imath::V3d back = from - Imath::V3d(n[3], n[4], n[5]);
    if (!(back.length() > 0) || !(n[6] > 0 && n[6] < 180))
        throw UsageError("--camera " + text +
                         ": expected a target away from the camera and a field of view in (0, 180)");
    const Imath::V3d z = back.normalized();
    Imath::V3d x = Imath::V3d(0, 1, 0).cross(z);
    x = x.length() > 1e-6 ? x.normalized() : Imath::V3d(1, 0, 0);
    const Imath::V3d y = z.cross(x);
    Camera camera;
    camera.world_from_camera =
        Imath::M44d(x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, from.x, from.y, from.z, 1);
    camera.vertical_fov = n[6] * std::numbers::pi / 180;
    return camera;
}

bool is_file(const std::string& text) {
    std::error_code error;
    return std::filesystem::is_regular_file(text, error);
}

void run_render(const RenderOptions& options, Job& job) {
    require_distinct_files({options.points, options.scene, options.camera}, options.outputs);
    std::vector<FileWriter> files;
    for (const std::string& path : options.outputs) {
        if (!path.ends_with(".exr") && !path.ends_with(".png"))
            throw UsageError(path + ": expected a name that ends in .exr or .png");
        files.emplace_back(path);
    }

    const Input input = read_input(options.points);
    job.warn(input.scene.warnings);
    if (!input.points || input.points->cloud.irradiance.empty())
        throw UnsupportedInput(options.points + ": holds no lit points; expected a file that vmap light wrote");
    std::optional<Input> source;
    if (!options.scene.empty()) source = read_input(options.scene);

    const PointFile& points = *input.points;
    const Imath::Box3d bounds = bounds_of(points.cloud.points);
    Camera camera;
    if (!options.camera.empty() && is_file(options.camera))
        camera = choose_camera(read_input(options.camera).scene, bounds, "", job);
    else if (options.camera.find(',') != std::string::npos)
        camera = camera_from_numbers(options.camera);
    else
        camera = choose_camera(source ? source->scene : input.scene, bounds, options.camera, job);

    RenderConfig config;
    std::tie(config.width, config.height) = parse_size(options.size, camera.aspect);
    config.content = options.content;
    report_progress(job.progress(), "picture", 0);
    const Picture picture = render_picture(points.cloud, camera, config, source ? &source->scene : nullptr);
    OutputInfo info{.up = UpAxis::y,
                    .light_units = points.light_units,
                    .exposure = options.content == PictureContent::radiance
                                    ? choose_exposure(options.exposure, points.cloud)
                                    : options.exposure.value_or(1),
                    .source = points.source};
    for (FileWriter& file : files) {
        if (file.path().ends_with(".exr"))
            write_exr(file, picture, info);
        else
            write_png(file, picture, info);
    }
    for (FileWriter& file : files) file.finish();
    const auto lock = job.interruption().hold_off();
    for (FileWriter& file : files) file.commit();
}

}  // namespace

Command add_render_command(CLI::App& program) {
    CLI::App* app = program.add_subcommand("render", "Draws a picture of lit points");
    app->footer("Example: vmap render lit.ply --scene room.glb --size 1024 -o lit.png -o lit.exr");
    auto options = std::make_shared<RenderOptions>();
    app->add_option("FILE", options->points, "Points that vmap light wrote")->required();
    app->add_option("-o,--output", options->outputs, "Picture to write, .exr or .png; may repeat")
        ->required()
        ->allow_extra_args(false)
        ->type_name("FILE");
    app->add_option("--scene", options->scene,
                    "The scene that the points were sampled from: exact edges, textures at the picture's resolution")
        ->type_name("FILE");
    app->add_option(
           "--camera", options->camera,
           "A scene whose first camera is taken, X,Y,Z,TX,TY,TZ,FOV (place, target, vertical degrees; Y is up), or "
           "a camera of --scene by name or index")
        ->type_name("CAMERA");
    app->add_option("--size", options->size, "WIDTHxHEIGHT, or the height alone")
        ->type_name("SIZE")
        ->default_str("512");
    app->add_option("--exposure", options->exposure, "Of PNG files; default: chosen by the light")
        ->check(CLI::PositiveNumber)
        ->type_name("X");
    app->add_option("--show", options->content, "What pixels hold")
        ->transform(choice(std::map<std::string, PictureContent>{{"radiance", PictureContent::radiance},
                                                                 {"irradiance", PictureContent::irradiance},
                                                                 {"albedo", PictureContent::albedo},
                                                                 {"normals", PictureContent::normals}}))
        ->type_name("radiance|irradiance|albedo|normals")
        ->default_str("radiance");
    return {app, [options](Job& job) { run_render(*options, job); }};
}

}  // namespace vmap
