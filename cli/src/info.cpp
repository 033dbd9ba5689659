// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// vmap info: what is in a file and what the toolkit makes of it.
#include "commands.h"
#include "map_facts.h"

#include <vmap/importers/input.h>
#include <vmap/light_source.h>
#include <vmap/printable.h>
#include <vmap/surface_shading.h>

#include <Imath/ImathBox.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdio>

namespace vmap {
namespace {

using Json = nlohmann::ordered_json;

struct InfoOptions {
    std::string file;
    std::string scene;
    bool json = false;
};

struct Summary {
    std::size_t triangles = 0;
    std::size_t points = 0;
    double area = 0;           ///< of the surface's fronts, world units squared
    double emissive_area = 0;  ///< of the part of it whose material emits
    Imath::Box3d box;          ///< of triangles and points
};

Summary summarize(const Input& input) {
    Summary summary;
    const Scene& scene = input.scene;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
        const bool emits = scene.materials[mesh.material].emits();
        summary.triangles += mesh.triangle_count();
        for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
            const double area = world_area_normal(scene, i, t).length() / 2;
            summary.area += area;
            if (emits) summary.emissive_area += area;
            for (const Imath::V3d& v : world_triangle(scene, i, t)) summary.box.extendBy(v);
        }
    }
    if (input.points) {
        const PointCloud& points = input.points->cloud.points;
        summary.points = points.size();
        for (const Imath::V3f& p : points.positions) summary.box.extendBy(points.origin + Imath::V3d(p));
    }
    return summary;
}

Json to_json(const InfoOptions& options, const Input& input, const Summary& summary) {
    const Scene& scene = input.scene;
    Json json{{"input", printable(options.file)},
              {"triangles", summary.triangles},
              {"points", summary.points},
              {"meshes", scene.meshes.size()},
              {"instances", scene.instances.size()},
              {"materials", scene.materials.size()},
              {"images", scene.images.size()},
              {"area", summary.area},
              {"emissive_area", summary.emissive_area},
              {"lights", scene.lights.size()},
              {"cameras", scene.cameras.size()}};
    if (!summary.box.isEmpty())
        json["box"] = {{summary.box.min.x, summary.box.min.y, summary.box.min.z},
                       {summary.box.max.x, summary.box.max.y, summary.box.max.z}};
    json["extensions"] = scene.extensions;
    json["warnings"] = Json::array();
    for (const std::string& warning : scene.warnings) json["warnings"].push_back(printable(warning));
    return json;
}

void print_text(const Json& json) {
    for (const auto& [key, value] : json.items()) {
        const std::string text =
            value.is_string() ? value.get<std::string>() : value.dump(-1, ' ', false, Json::error_handler_t::replace);
        fmt::print("{:<27} {}\n", key, text);
    }
}

Json scene_facts(const InfoOptions& options, Job& job) {
    const Input input =
        read_input(options.file, {.scene = options.scene.empty() ? std::optional<std::string>() : options.scene,
                                  .light_units = LightUnits::compat,
                                  .up = std::nullopt});
    job.warn(input.scene.warnings);
    return to_json(options, input, summarize(input));
}

void run_info(const InfoOptions& options, Job& job) {
    const Json json = is_vmap_file(options.file) ? map_facts(options.file) : scene_facts(options, job);
    if (options.json)
        fmt::print("{}\n", json.dump(1, ' ', false, Json::error_handler_t::replace));
    else
        print_text(json);
}

}  // namespace

Command add_info_command(CLI::App& program) {
    CLI::App* app = program.add_subcommand("info", "Tells what is in a file and what will be used of it");
    app->footer("Example: vmap info room.glb --json");
    auto options = std::make_shared<InfoOptions>();
    app->add_option("FILE", options->file, "Any file that vmap reads")->required();
    app->add_option("--scene", options->scene, "glTF: the scene to read, by name or index")->type_name("NAME");
    app->add_flag("--json", options->json, "As one JSON object");
    return {app, [options](Job& job) { run_info(*options, job); }};
}

}  // namespace vmap
