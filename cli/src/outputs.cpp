// SPDX-License-Identifier: GPL-3.0-or-later
#include "outputs.h"

#include "choice.h"

#include <vmap/error.h>
#include <vmap/exporters/camera_placement.h>
#include <vmap/exporters/exr.h>
#include <vmap/exporters/gltf_points.h>
#include <vmap/exporters/ply.h>
#include <vmap/exporters/png.h>
#include <vmap/exporters/render_picture.h>
#include <vmap/exporters/vdb_grid.h>
#include <vmap/exporters/vdb_points.h>
#include <vmap/printable.h>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>

namespace vmap {
namespace {

OutputFormat format_of(const std::string& path) {
    if (path == "-") return OutputFormat::ply;
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    static const std::map<std::string, OutputFormat> formats{
        {".ply", OutputFormat::ply}, {".gltf", OutputFormat::gltf}, {".glb", OutputFormat::gltf},
        {".vdb", OutputFormat::vdb}, {".exr", OutputFormat::exr},   {".png", OutputFormat::png}};
    const auto found = formats.find(extension);
    if (found == formats.end())
        throw UsageError(fmt::format("{}: unknown extension '{}'; expected .ply, .glb, .gltf, .vdb, .exr, .png or -",
                                     path, extension));
    return found->second;
}

bool is_picture(OutputFormat format) {
    return format == OutputFormat::exr || format == OutputFormat::png;
}

std::optional<std::size_t> index_from(const std::string& text, std::size_t count) {
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
    if (error != std::errc() || end != text.data() + text.size() || index >= count) return {};
    return index;
}

}  // namespace

void add_output_options(CLI::App& app, OutputOptions& options) {
    app.add_option("-o,--output", options.paths,
                   "File to write, may repeat; by extension: .ply, .glb, .gltf, .vdb, .exr, .png; - is PLY on standard "
                   "output")
        ->type_name("FILE")
        ->allow_extra_args(false)
        ->required();
    app.add_option("--up", options.up, "Axis that is up in the files; default: y for glTF, z for PLY and VDB")
        ->transform(choice(std::map<std::string, UpAxis>{{"y", UpAxis::y}, {"z", UpAxis::z}}))
        ->type_name("y|z");
    app.add_option("--vdb", options.vdb_points, "VDB: a grid of irradiance or the points themselves")
        ->transform(choice(std::map<std::string, bool>{{"grid", false}, {"points", true}}))
        ->type_name("grid|points")
        ->default_str("grid");
    app.add_option("--voxel", options.voxel, "VDB grid: edge of a voxel, world units; default: twice the spacing")
        ->check(CLI::PositiveNumber)
        ->type_name("S");
    app.add_option("--exposure", options.exposure, "Of PNG and display colours; default: chosen by the light")
        ->check(CLI::PositiveNumber)
        ->type_name("X");
    app.add_option("--size", options.size, "Of pictures: WIDTHxHEIGHT, or the height alone")
        ->type_name("SIZE")
        ->default_str("512");
    app.add_option("--camera", options.camera, "Pictures: camera of the scene, by name or index")->type_name("NAME");
}

std::pair<int, int> parse_size(const std::string& size, double aspect) {
    const std::size_t cross = size.find('x');
    const auto number = [&](std::string_view text) {
        int value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc() || end != text.data() + text.size() || value < 1 || value > 16384)
            throw UsageError(fmt::format("--size {}: expected WIDTHxHEIGHT or HEIGHT, 1 to 16384 each", size));
        return value;
    };
    const std::string_view text(size);
    if (cross != std::string::npos) return {number(text.substr(0, cross)), number(text.substr(cross + 1))};
    const int height = number(text);
    const double width = height * (aspect > 0 ? aspect : 1);
    return {static_cast<int>(std::clamp(std::round(width), 1.0, 16384.0)), height};
}

Camera choose_camera(const Scene& scene, const Imath::Box3d& bounds, const std::string& wanted, Job& job) {
    if (!wanted.empty()) {
        const auto named = std::find_if(scene.cameras.begin(), scene.cameras.end(),
                                        [&](const Camera& camera) { return camera.name == wanted; });
        if (named != scene.cameras.end()) return *named;
        const std::optional<std::size_t> index = index_from(wanted, scene.cameras.size());
        if (index) return scene.cameras[*index];
        throw UsageError(fmt::format("--camera {}: the scene has {} cameras and none of that name", printable(wanted),
                                     scene.cameras.size()));
    }
    if (!scene.cameras.empty()) return scene.cameras.front();
    job.warn("no camera in the scene: one was placed that sees everything");
    return place_camera(bounds);
}

double choose_exposure(const std::optional<double>& wanted, const LitCloud& cloud) {
    return wanted ? *wanted : automatic_exposure(cloud);
}

Outputs::Outputs(const OutputOptions& options) : options_(options) {
    static_cast<void>(parse_size(options_.size, 1));  // found out before the work, not after it
    std::vector<OutputFormat> formats;
    formats.reserve(options_.paths.size());
    for (const std::string& path : options_.paths) formats.push_back(format_of(path));
    for (std::size_t i = 0; i < formats.size(); ++i) outputs_.push_back({formats[i], FileWriter(options_.paths[i])});
}

bool Outputs::needs_picture() const {
    return std::any_of(outputs_.begin(), outputs_.end(), [](const Output& o) { return is_picture(o.format); });
}

OutputInfo Outputs::info_for(OutputFormat format, OutputInfo info) const {
    info.up = options_.up.value_or(format == OutputFormat::gltf ? UpAxis::y : UpAxis::z);
    return info;
}

void Outputs::write(const LitCloud& cloud, const Scene& scene, OutputInfo info, Job& job) {
    info.exposure = choose_exposure(options_.exposure, cloud);
    const ProgressCallback progress = job.progress();
    std::optional<Picture> picture;
    for (Output& output : outputs_) {
        const OutputInfo own = info_for(output.format, info);
        report_progress(progress, "write", 0);
        switch (output.format) {
            case OutputFormat::ply:
                write_ply(output.file, cloud, own, progress);
                break;
            case OutputFormat::gltf:
                write_gltf_points(output.file, cloud, own,
                                  {.container = output.file.path().ends_with(".gltf") ? GltfContainer::embedded
                                                                                      : GltfContainer::binary},
                                  progress);
                break;
            case OutputFormat::vdb:
                if (options_.vdb_points)
                    write_vdb_points(output.file, cloud, own, progress);
                else
                    write_vdb_grid(output.file, cloud, own, {.voxel_size = options_.voxel.value_or(0)}, progress);
                break;
            case OutputFormat::exr:
            case OutputFormat::png:
                if (!picture) {
                    const Camera camera = choose_camera(scene, bounds_of(cloud.points), options_.camera, job);
                    const auto [width, height] = parse_size(options_.size, camera.aspect);
                    picture = render_picture(cloud, camera, {.width = width, .height = height},
                                             scene.instances.empty() ? nullptr : &scene);
                }
                if (output.format == OutputFormat::exr)
                    write_exr(output.file, *picture, own);
                else
                    write_png(output.file, *picture, own);
                break;
        }
    }
}

void Outputs::commit(Job& job, FileWriter* also) {
    for (Output& output : outputs_) output.file.finish();
    if (also != nullptr) also->finish();
    job.interruption().check();
    const auto lock = job.interruption().hold_off();
    for (Output& output : outputs_) output.file.commit();
    if (also != nullptr) also->commit();
}

}  // namespace vmap
