// SPDX-License-Identifier: GPL-3.0-or-later
// vmap-crosscheck: the figures of the cross-check, and the page that shows it.
#include <crosscheck/cases.h>
#include <crosscheck/page.h>
#include <vmap/error.h>
#include <vmap/exporters/file_writer.h>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <exception>
#include <string>
#include <vector>

namespace vmap::crosscheck {
namespace {

struct Arguments {
    std::string cases = VMAP_CASES;
    std::string scenes = VMAP_SCENES;
    std::string models = VMAP_SHARED "/models";
    std::string cache;
    std::vector<std::string> only;
    std::string page;
    std::string row;
};

bool is_wanted(const Arguments& arguments, const Case& item) {
    return arguments.only.empty() ||
           std::find(arguments.only.begin(), arguments.only.end(), item.name) != arguments.only.end();
}

void print_figures(const Case& item, const Crosscheck& check) {
    fmt::print("{}: ours {:.2f} s, POV-Ray {:.1f} s{}, {} pixels, noise of the truth {:.2f} %\n", item.name,
               check.our_seconds, check.povray.seconds, check.povray.kept ? " (kept)" : "", check.pixels.size(),
               100 * check.truth_noise);
    for (const auto& [name, figures] : figures_of(check))
        fmt::print("  {:<8} {:>6} mean {:7.3f} median {:7.3f} p95 {:7.3f} p99 {:7.3f} bias {:+7.3f} %\n", name,
                   figures.count, 100 * figures.mean, 100 * figures.median, 100 * figures.p95, 100 * figures.p99,
                   100 * figures.bias);
    std::fflush(stdout);
}

void write_text(const std::string& path, const std::string& text) {
    FileWriter file(path);
    file.write(text.data(), text.size());
    file.commit();
}

/// One scene as a square row for a document: larger than the pictures of the page.
void write_row(const std::string& path, const Scene& scene, CrosscheckConfig config) {
    config.width = 240;
    config.height = 240;
    const Crosscheck check = cross_check(scene, config);
    write_text(path, png_bytes(picture_row(check)));
    fmt::print("{}: errors end at {:g} %; ours {:.2f} %, POV-Ray's {:.2f} % in the mean\n", path,
               100 * error_scale(check), 100 * check.our_error.mean, 100 * check.povray_error.mean);
}

int run(const Arguments& arguments) {
    Page page;
    for (Case& item : read_cases(arguments.cases)) {
        if (!is_wanted(arguments, item)) continue;
        const std::optional<Scene> scene = scene_of(item, arguments.scenes, arguments.models);
        if (!scene) {
            fmt::print("{}: its model is not there\n", item.name);
            continue;
        }
        CrosscheckConfig& config = arguments.page.empty() ? item.config : item.slow;
        config.cache = arguments.cache;
        const Crosscheck check = cross_check(*scene, config);
        print_figures(item, check);
        if (!arguments.page.empty()) page.add(item, check);
        if (!arguments.row.empty() && item.name == "cornell_box") write_row(arguments.row, *scene, config);
    }
    if (!arguments.page.empty())
        write_text(arguments.page,
                   page.html(povray_version(), fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr)))));
    return 0;
}

int parse_and_run(int argc, char** argv) {
    Arguments arguments;
    CLI::App app("Compares our light with POV-Ray's and with the path tracer's on the scenes of the cross-check.");
    app.add_option("--cases", arguments.cases, "JSON file of the cases")->capture_default_str();
    app.add_option("--scenes", arguments.scenes, "Folder of the scenes")->capture_default_str();
    app.add_option("--models", arguments.models, "Folder of the larger models")->capture_default_str();
    app.add_option("--cache", arguments.cache, "Folder that keeps pictures and truths")->required();
    app.add_option("--only", arguments.only, "Names of cases; all when left out");
    auto* page = app.add_option("--page", arguments.page, "HTML page to write, at the slower settings of the cases");
    app.add_option("--row", arguments.row, "PNG picture of the Cornell box by all three to write")->needs(page);
    CLI11_PARSE(app, argc, argv);
    return run(arguments);
}

}  // namespace
}  // namespace vmap::crosscheck

int main(int argc, char** argv) {
    try {
        return vmap::crosscheck::parse_and_run(argc, argv);
    } catch (const std::exception& error) {
        fmt::print(stderr, "vmap-crosscheck: error: {}\n", error.what());
        return 1;
    }
}
