// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// vmap sample: a scene as points without light.
#include "commands.h"
#include "distinct_files.h"
#include "load_points.h"
#include "outputs.h"
#include "report.h"
#include "stopwatch.h"

#include <optional>
#include <string>
#include <vector>

namespace vmap {
namespace {

struct SampleOptions {
    LoadOptions load;
    OutputOptions output;
    std::string report;
};

void run_sample(const SampleOptions& options, Job& job) {
    const Stopwatch total;
    std::vector<std::string> written = options.output.paths;
    written.push_back(options.report);
    require_distinct_files({options.load.file}, written);
    Outputs outputs(options.output);
    std::optional<FileWriter> report_file;
    if (!options.report.empty()) report_file.emplace(options.report);

    const LoadedPoints loaded = load_points(options.load, job);
    const Stopwatch writing;
    outputs.write(loaded.cloud, loaded.scene, loaded.info, job);
    if (report_file) {
        const JobReport report{.input = options.load.file,
                               .points = loaded.cloud.points.size(),
                               .lights = loaded.lights.size(),
                               .area = total_area(loaded.cloud.points),
                               .seconds = {.import = loaded.import_seconds,
                                           .sample = loaded.sample_seconds,
                                           .write = writing.seconds(),
                                           .total = total.seconds()},
                               .light = std::nullopt,
                               .map = std::nullopt,
                               .outputs = outputs.paths()};
        write_report(*report_file, report, job);
    }
    outputs.commit(job, report_file ? &*report_file : nullptr);
}

}  // namespace

Command add_sample_command(CLI::App& program) {
    CLI::App* app = program.add_subcommand("sample", "Turns a scene into oriented points, without light");
    app->footer("Example: vmap sample room.glb -o points.ply --spacing 0.02");
    auto options = std::make_shared<SampleOptions>();
    add_load_options(*app, options->load);
    add_output_options(*app, options->output);
    app->add_option("--json", options->report, "Writes a report there; - is standard output")->type_name("FILE");
    return {app, [options](Job& job) { run_sample(*options, job); }};
}

}  // namespace vmap
