// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// vmap compare: how much a picture, a lit cloud or a visibility map differs from another one.
#include "commands.h"
#include "distinct_files.h"
#include "map_facts.h"

#include <vmap/compare/comparison.h>
#include <vmap/compare/html_report.h>
#include <vmap/error.h>
#include <vmap/exporters/file_writer.h>
#include <vmap/printable.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <optional>

namespace vmap {
namespace {

struct CompareOptions {
    std::string result;
    std::string reference;
    ComparisonLimits limits;
    std::string html;
    std::string json;

    [[nodiscard]] bool has_limits() const {
        return limits.mean || limits.median || limits.p95 || limits.p99 || limits.rmse || limits.bias || limits.flip;
    }
};

void print_text(const Comparison& comparison) {
    const DifferenceFigures& figures = comparison.figures();
    const auto print = [](const char* name, double value) { fmt::print("{:<8} {:9.4f} %\n", name, 100 * value); };
    print("mean", figures.mean);
    print("median", figures.median);
    print("p95", figures.p95);
    print("p99", figures.p99);
    print("largest", figures.largest);
    print("rmse", figures.rmse);
    print("bias", figures.bias);
    if (comparison.pictures) fmt::print("{:<8} {:9.4f}\n", "flip", comparison.pictures->comparison.flip);
    if (comparison.clouds)
        fmt::print("{:<8} {:9.4g} (spacing {:.4g})\n", "distance", comparison.clouds->mean_distance,
                   comparison.clouds->spacing);
    fmt::print("of the mean of the reference, {:.5g}, over {} {}\n", figures.mean_reference, figures.count,
               comparison.pictures ? "pixels" : "points");
}

std::string joined(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) text += (text.empty() ? "" : ", ") + line;
    return text;
}

/// Maps are alike or not: there is nothing to limit and nothing to see.
void run_map_compare(const CompareOptions& options, Job& job) {
    if (!is_vmap_file(options.result) || !is_vmap_file(options.reference))
        throw UsageError(fmt::format("{} and {}: only one is a visibility map; expected two files of one kind",
                                     printable(options.result), printable(options.reference)));
    if (options.has_limits() || !options.html.empty())
        throw UsageError("--html and --max-...: expected pictures or clouds, not visibility maps");
    std::optional<FileWriter> json;
    if (!options.json.empty()) json.emplace(options.json);
    const nlohmann::ordered_json parts = compare_maps(options.result, options.reference);
    if (json) {
        json->stream() << parts.dump(1) << '\n';
        json->finish();
        json->commit();
    }
    std::vector<std::string> different;
    for (const auto& [part, difference] : parts.items()) {
        const auto text = difference.get<std::string>();
        if (options.json != "-" && !job.options().quiet) fmt::print("{:<13} {}\n", part, text);
        if (text != "same") different.push_back(fmt::format("{} {}", part, text));
    }
    if (!different.empty())
        throw Error(ExitCode::comparison_failed, fmt::format("{} against {}: {}", printable(options.result),
                                                             printable(options.reference), joined(different)));
}

void run_compare(const CompareOptions& options, Job& job) {
    require_distinct_files({options.result, options.reference}, {options.html, options.json});
    if (is_vmap_file(options.result) || is_vmap_file(options.reference)) return run_map_compare(options, job);
    std::optional<FileWriter> html;
    std::optional<FileWriter> json;
    if (!options.html.empty()) html.emplace(options.html);
    if (!options.json.empty()) json.emplace(options.json);

    const Comparison comparison = compare_files(options.result, options.reference);
    if (options.limits.flip && !comparison.pictures) throw UsageError("--max-flip: clouds have no FLIP");
    if (html) write_html_report(*html, comparison);
    if (json)
        json->stream() << json_of(comparison).dump(1, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
    if (options.json != "-" && options.html != "-" && !job.options().quiet) print_text(comparison);
    if (html) html->finish();
    if (json) json->finish();
    job.interruption().check();
    if (html) html->commit();
    if (json) json->commit();

    const std::vector<std::string> exceeded = exceeded_limits(comparison, options.limits);
    if (!exceeded.empty())
        throw Error(ExitCode::comparison_failed, fmt::format("{} against {}: {}", printable(options.result),
                                                             printable(options.reference), joined(exceeded)));
}

}  // namespace

Command add_compare_command(CLI::App& program) {
    CLI::App* app =
        program.add_subcommand("compare", "Tells how much a picture, a lit cloud or a map differs from another one");
    app->footer(
        "Pictures (EXR, PNG) are compared by pixel, lit clouds by nearest point of the same side. All figures are\n"
        "fractions of the mean of the reference; FLIP is between 0 and 1. Exceeded limits give exit code 5, and so do\n"
        "visibility maps (.vmap) that differ in anything but the seconds they took.\n"
        "Example: vmap compare ours.exr povray.exr --max-median 0.02 --max-p95 0.06 --html report.html");
    auto options = std::make_shared<CompareOptions>();
    app->add_option("A", options->result, "What is judged")->required();
    app->add_option("B", options->reference, "What it should be like")->required();
    const auto add_limit = [&](const char* name, std::optional<double>& limit, const char* figure) {
        app->add_option(name, limit, fmt::format("Highest {} that passes", figure))
            ->check(CLI::NonNegativeNumber)
            ->type_name("X");
    };
    add_limit("--max-mean", options->limits.mean, "mean difference");
    add_limit("--max-median", options->limits.median, "median");
    add_limit("--max-p95", options->limits.p95, "95th percentile");
    add_limit("--max-p99", options->limits.p99, "99th percentile");
    add_limit("--max-rmse", options->limits.rmse, "root of the mean square");
    add_limit("--max-bias", options->limits.bias, "difference of the means, whatever its sign,");
    add_limit("--max-flip", options->limits.flip, "mean FLIP");
    app->add_option("--html", options->html, "Writes a page with pictures, maps and the histogram there")
        ->type_name("FILE");
    app->add_option("--json", options->json, "Writes the figures there; - is standard output")->type_name("FILE");
    return {app, [options](Job& job) { run_compare(*options, job); }};
}

}  // namespace vmap
