// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// vmap info: what is in a file and what the toolkit makes of it.
#include "commands.h"
#include "load_points.h"
#include "map_facts.h"
#include "scene_facts.h"

#include <vmap/importers/input.h>

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

std::string text_of(const Json& value) {
    return value.is_string() ? value.get<std::string>() : value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// One line a fact; a list of texts or objects has one line an entry.
void print_text(const Json& json) {
    for (const auto& [key, value] : json.items()) {
        const bool is_list = value.is_array() && !value.empty() && (value[0].is_string() || value[0].is_object());
        if (!is_list) {
            fmt::print("{:<27} {}\n", key, text_of(value));
            continue;
        }
        for (std::size_t i = 0; i < value.size(); ++i) fmt::print("{:<27} {}\n", i == 0 ? key : "", text_of(value[i]));
    }
}

Json facts_of_input(const InfoOptions& options, Job& job) {
    const Input input = read_input(options.file, input_config(options.scene, LightUnits::compat));
    job.warn(input.scene.warnings);
    return scene_facts(options.file, input);
}

void run_info(const InfoOptions& options, Job& job) {
    const Json json = is_vmap_file(options.file) ? map_facts(options.file) : facts_of_input(options, job);
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
