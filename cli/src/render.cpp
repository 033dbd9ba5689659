// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// vmap render: a picture of lit points or of a visibility map.
#include "choice.h"
#include "commands.h"
#include "distinct_files.h"
#include "load_points.h"
#include "map_facts.h"
#include "map_picture.h"
#include "outputs.h"
#include "parse_values.h"
#include "raw_points.h"

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

enum class Show { radiance, irradiance, albedo, normals, visibility, umbra, leaves };

struct RenderOptions {
    std::string points;
    std::string camera;
    std::string scene;
    std::vector<std::string> outputs;
    std::string size = "512";
    RawPointOptions raw;
    std::optional<double> exposure;
    Show show = Show::radiance;
    std::string from;
};

/// What is drawn, and where it comes from.
struct Subject {
    LitCloud cloud;
    Scene scene;  ///< with the file's cameras
    LightUnits light_units = LightUnits::compat;
    std::string source;
    std::vector<Imath::C3f> paint;  ///< of maps only
};

PictureContent content_of(Show show) {
    switch (show) {
        case Show::radiance:
            return PictureContent::radiance;
        case Show::irradiance:
            return PictureContent::irradiance;
        case Show::albedo:
            return PictureContent::albedo;
        case Show::normals:
            return PictureContent::normals;
        case Show::visibility:
        case Show::umbra:
        case Show::leaves:
            break;
    }
    return PictureContent::paint;
}

Subject read_lit_points(const RenderOptions& options, Job& job) {
    Input input = read_input(options.points);
    job.warn(input.scene.warnings);
    const bool needs_light = options.show == Show::radiance || options.show == Show::irradiance;
    if (!input.points || (needs_light && input.points->cloud.irradiance.empty()))
        throw UnsupportedInput(printable(options.points) +
                               ": holds no lit points; expected a file that vmap light wrote");
    Scene scene = std::move(input.scene);
    PointFile points = complete_points(std::move(input), options.points, options.raw, scene.lights, job);
    return {std::move(points.cloud), std::move(scene), points.light_units, std::move(points.source), {}};
}

Subject read_map(const RenderOptions& options) {
    if (!is_vmap_file(options.points))
        throw UnsupportedInput(printable(options.points) + ": is no visibility map; expected a file of vmap build");
    VmapContents contents = read_vmap(options.points);
    if (contents.cloud.empty()) throw UnsupportedInput(printable(options.points) + ": has no points");
    Subject subject;
    if (options.show == Show::visibility)
        subject.paint = paint_visibility(contents, parse_vector("--from", options.from));
    else
        subject.paint = options.show == Show::umbra ? paint_umbra(contents) : paint_leaves(contents);
    subject.cloud.points = std::move(contents.cloud);
    subject.scene.cameras = std::move(contents.cameras);
    subject.light_units = contents.light_units;
    subject.source = std::move(contents.source);
    return subject;
}

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

    if ((options.show == Show::visibility) == options.from.empty())
        throw UsageError("--from: expected with --show visibility, and only there");
    const PictureContent content = content_of(options.show);
    const Subject subject = content == PictureContent::paint ? read_map(options) : read_lit_points(options, job);
    std::optional<Input> source;
    if (!options.scene.empty()) source = read_input(options.scene);

    const Imath::Box3d bounds = bounds_of(subject.cloud.points);
    Camera camera;
    if (!options.camera.empty() && is_file(options.camera))
        camera = choose_camera(read_input(options.camera).scene, bounds, "", job);
    else if (options.camera.find(',') != std::string::npos)
        camera = camera_from_numbers(options.camera);
    else
        camera = choose_camera(source ? source->scene : subject.scene, bounds, options.camera, job);

    RenderConfig config;
    std::tie(config.width, config.height) = parse_size(options.size, camera.aspect);
    config.content = content;
    config.paint = subject.paint;
    report_progress(job.progress(), "picture", 0);
    const Picture picture = render_picture(subject.cloud, camera, config, source ? &source->scene : nullptr);
    OutputInfo info{.up = UpAxis::y,
                    .light_units = subject.light_units,
                    .exposure = content == PictureContent::radiance ? choose_exposure(options.exposure, subject.cloud)
                                                                    : options.exposure.value_or(1),
                    .source = subject.source};
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
    CLI::App* app = program.add_subcommand("render", "Draws a picture of lit points or of a visibility map");
    app->footer("Example: vmap render lit.ply --scene room.glb --size 1024 -o lit.png -o lit.exr");
    auto options = std::make_shared<RenderOptions>();
    app->add_option("FILE", options->points, "Points that vmap light wrote, or a map of vmap build")->required();
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
    app->add_option(
           "--show", options->show,
           "What pixels hold. Of a .vmap file: what the point at --from sees, what the lights reach, the leaves")
        ->transform(choice(std::map<std::string, Show>{{"radiance", Show::radiance},
                                                       {"irradiance", Show::irradiance},
                                                       {"albedo", Show::albedo},
                                                       {"normals", Show::normals},
                                                       {"visibility", Show::visibility},
                                                       {"umbra", Show::umbra},
                                                       {"leaves", Show::leaves}}))
        ->type_name("radiance|irradiance|albedo|normals|visibility|umbra|leaves")
        ->default_str("radiance");
    app->add_option("--from", options->from, "The place whose next point looks, with --show visibility")
        ->type_name("X,Y,Z");
    add_raw_point_options(*app, options->raw);
    return {app, [options](Job& job) { run_render(*options, job); }};
}

}  // namespace vmap
