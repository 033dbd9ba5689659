// SPDX-License-Identifier: GPL-3.0-or-later
// vmap-reference: how far a lit cloud is from the path-traced truth of its scene.
#include <reference/measure.h>
#include <vmap/error.h>
#include <vmap/importers/input.h>
#include <vmap/light_units.h>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <chrono>
#include <cstdio>
#include <exception>
#include <map>
#include <string>

namespace vmap::reference {
namespace {

struct Arguments {
    std::string scene;
    std::string cloud;
    InputConfig input;
    MeasureConfig measure;
    bool json = false;
    double max_error = 0;
    double max_p99 = 0;
};

nlohmann::json json_of(const ErrorFigures& figures) {
    return {{"points", figures.points}, {"mean_truth", figures.mean_truth},
            {"ratio", figures.ratio},   {"error", figures.error},
            {"p50", figures.p50},       {"p95", figures.p95},
            {"p99", figures.p99},       {"largest", figures.largest},
            {"noise", figures.noise}};
}

void print_row(const char* name, const ErrorFigures& figures) {
    fmt::print("{:<22}{:>8}{:>11.5g}{:>10.5f}{:>9.3f}{:>9.3f}{:>9.3f}{:>9.3f}{:>9.3f}\n", name, figures.points,
               figures.mean_truth, figures.ratio, 100 * figures.error, 100 * figures.p50, 100 * figures.p95,
               100 * figures.p99, 100 * figures.noise);
}

/// Light units that the cloud was lit with, as its header says.
LightUnits units_of(const LitPly& cloud) {
    const auto found = cloud.comments.find("light_units");
    if (found == cloud.comments.end()) return LightUnits::compat;
    const std::string name = found->second.substr(0, found->second.find(' '));
    if (name == "spec") return LightUnits::spec;
    return name == "raw" ? LightUnits::raw : LightUnits::compat;
}

int run(Arguments& arguments) {
    const auto start = std::chrono::steady_clock::now();
    const LitPly cloud = read_lit_ply(arguments.cloud);
    arguments.input.light_units = units_of(cloud);
    const Scene scene = read_input(arguments.scene, arguments.input).scene;
    const Measurement found = measure(scene, cloud, arguments.measure);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

    if (arguments.json) {
        nlohmann::json report{{"scene", arguments.scene},
                              {"cloud", arguments.cloud},
                              {"samples", found.samples},
                              {"seconds", seconds},
                              {"all", json_of(found.all)}};
        if (arguments.measure.away_from_silhouettes) {
            report["away_from_silhouettes"] = json_of(found.away);
            report["left_out"] = found.left_out;
        }
        fmt::print("{}\n", report.dump(1));
    } else {
        fmt::print("{:<22}{:>8}{:>11}{:>10}{:>9}{:>9}{:>9}{:>9}{:>9}\n", "", "points", "mean E", "ratio", "error %",
                   "p50 %", "p95 %", "p99 %", "noise %");
        print_row("all", found.all);
        if (arguments.measure.away_from_silhouettes) {
            print_row("away from silhouettes", found.away);
            fmt::print("left out {:.2f} % of the area\n", 100 * found.left_out);
        }
        fmt::print("{} samples per point, {:.1f} s\n", found.samples, seconds);
    }
    const bool failed = (arguments.max_error > 0 && found.all.error > arguments.max_error) ||
                        (arguments.max_p99 > 0 && found.all.p99 > arguments.max_p99);
    return static_cast<int>(failed ? ExitCode::comparison_failed : ExitCode::ok);
}

int parse_and_run(int argc, char** argv) {
    Arguments arguments;
    std::string scene_name;
    CLI::App app(
        "Compares the irradiance of a lit cloud with path-traced truth at its points.\n"
        "Example: vmap-reference scene.glb lit.ply --points 4000 --noise 0.001 --cache build/truth");
    app.add_option("scene", arguments.scene, "File of meshes that the cloud was made from")->required();
    app.add_option("cloud", arguments.cloud, "PLY file that vmap light wrote")->required();
    app.add_option("--scene-name", scene_name, "Name or index of the scene in the file");
    app.add_option("--points", arguments.measure.points, "Points to look at, drawn by area")->capture_default_str();
    app.add_option("--samples", arguments.measure.samples, "Paths per point; 0 for as many as --noise needs")
        ->capture_default_str();
    app.add_option("--noise", arguments.measure.noise, "Standard error of the truth over its mean")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    app.add_option("--bounces", arguments.measure.max_bounces, "Reflections that count; 0 for direct light only");
    app.add_option("--seed", arguments.measure.seed, "Of the draw and of the paths")->capture_default_str();
    app.add_option("--cache", arguments.measure.cache, "Folder that keeps truths for the next run");
    app.add_flag("--silhouettes", arguments.measure.away_from_silhouettes,
                 "Also figures away from shadow edges and contacts");
    app.add_flag("--json", arguments.json, "Print one JSON object");
    app.add_option("--max-error", arguments.max_error, "Exit with 5 when the mean error is above this fraction");
    app.add_option("--max-p99", arguments.max_p99, "Exit with 5 when the 99th percentile is above this fraction");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : static_cast<int>(ExitCode::usage);
    }
    if (!scene_name.empty()) arguments.input.scene = scene_name;
    return run(arguments);
}

}  // namespace
}  // namespace vmap::reference

int main(int argc, char** argv) {
    try {
        return vmap::reference::parse_and_run(argc, argv);
    } catch (const vmap::Error& error) {
        fmt::print(stderr, "vmap-reference: error: {}\n", error.what());
        return static_cast<int>(error.code());
    } catch (const std::exception& error) {
        fmt::print(stderr, "vmap-reference: error: {}\n", error.what());
        return static_cast<int>(vmap::ExitCode::run_error);
    }
}
