// SPDX-License-Identifier: GPL-3.0-or-later
// bench_picture: seconds of light and picture of the Cornell box, and its error against the path tracer's picture
// beside that of POV-Ray's at two settings. POV-Ray takes minutes; its pictures and the truth are kept, with the times
// they took.
#include <crosscheck/crosscheck.h>
#include <vmap/importers/input.h>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

namespace vmap::crosscheck {
namespace {

struct Arguments {
    std::string scene = VMAP_SCENES "/cornell_box.gltf";
    std::string cache = VMAP_CROSSCHECK_CACHE;
    int size = 512;
    int runs = 5;
    CrosscheckConfig config;
};

void print_row(const std::string& name, double seconds, const DifferenceFigures& figures) {
    fmt::print("{:<24} {:>8.2f} {:>8.2f} {:>8.2f} {:>8.2f} {:>+8.2f}\n", name, seconds, 100 * figures.mean,
               100 * figures.median, 100 * figures.p95, 100 * figures.bias);
    std::fflush(stdout);
}

void run(const Arguments& arguments) {
    std::filesystem::create_directories(arguments.cache);
    const Scene scene = read_input(arguments.scene).scene;
    CrosscheckConfig config = arguments.config;
    config.width = arguments.size;
    config.height = arguments.size;
    config.cache = arguments.cache;

    fmt::print("{:<24} {:>8} {:>8} {:>8} {:>8} {:>8}\n", "", "seconds", "mean %", "median %", "p95 %", "bias %");
    config.preset = PovPreset::normal;
    const Crosscheck normal = cross_check(scene, config);
    double fastest = light_and_draw(scene, config).seconds;
    for (int i = 1; i < arguments.runs; ++i) fastest = std::min(fastest, light_and_draw(scene, config).seconds);
    print_row("vmap, light and picture", fastest, normal.our_error);
    print_row("POV-Ray, normal", normal.povray.seconds, normal.povray_error);
    config.preset = PovPreset::reference;
    const Crosscheck reference = cross_check(scene, config);
    print_row("POV-Ray, reference", reference.povray.seconds, reference.povray_error);
    fmt::print(
        "{} pixels; noise of the path tracer {:.2f} %; POV-Ray on one thread, processor seconds of when it ran\n",
        normal.our_error.count, 100 * normal.truth_noise);
}

int parse_and_run(int argc, char** argv) {
    Arguments arguments;
    arguments.config.truth_pixels = 4000;
    arguments.config.truth_samples = 4096;
    CLI::App app(
        "Times light and picture of the Cornell box and compares the picture with a path tracer's and POV-Ray's.");
    app.add_option("--scene", arguments.scene, "glTF file with a camera")->capture_default_str();
    app.add_option("--size", arguments.size, "Edge of the picture, pixels")->capture_default_str();
    app.add_option("--points", arguments.config.points, "Points of the cloud")->capture_default_str();
    app.add_option("--tolerance", arguments.config.tolerance, "Of the light")->capture_default_str();
    app.add_option("--runs", arguments.runs, "Runs of which the fastest counts")->capture_default_str();
    app.add_option("--cache", arguments.cache, "Folder that keeps pictures and truths")->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    run(arguments);
    return 0;
}

}  // namespace
}  // namespace vmap::crosscheck

int main(int argc, char** argv) {
    try {
        return vmap::crosscheck::parse_and_run(argc, argv);
    } catch (const std::exception& error) {
        fmt::print(stderr, "bench_picture: error: {}\n", error.what());
        return 1;
    }
}
