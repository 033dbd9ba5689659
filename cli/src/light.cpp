// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// vmap light: the main job.
#include "commands.h"
#include "distinct_files.h"
#include "load_points.h"
#include "outputs.h"
#include "parse_values.h"
#include "report.h"
#include "stopwatch.h"

#include <vmap/compare/picture_file.h>
#include <vmap/error.h>
#include <vmap/light.h>

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vmap {
namespace {

struct LightOptions {
    LoadOptions load;
    OutputOptions output;
    LightConfig light;
    std::string sky;
    std::string report;
};

double mean_irradiance(const LitCloud& cloud) {
    double sum = 0;
    double area = 0;
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
        const Imath::C3f& e = cloud.irradiance[i];
        const auto a = static_cast<double>(cloud.points.areas[i]);
        sum += static_cast<double>(e.x + e.y + e.z) / 3 * a;
        area += a;
    }
    return area > 0 ? sum / area : 0;
}

/// Numbers are one radiance from all around; anything else names a panorama.
Sky read_sky(const std::string& text) {
    const bool numbers = text.find_first_not_of("0123456789.,+-eE") == std::string::npos;
    if (numbers && !std::filesystem::exists(text)) return even_sky(parse_color("--sky", text));
    const Picture panorama = read_picture(text);
    return sky_of_panorama(panorama.pixels, panorama.width, panorama.height);
}

void run_light(LightOptions options, Job& job) {
    const Stopwatch total;
    std::vector<std::string> written = options.output.paths;
    written.push_back(options.report);
    require_distinct_files({options.load.file}, written);
    Outputs outputs(options.output);
    std::optional<FileWriter> report_file;
    if (!options.report.empty()) report_file.emplace(options.report);

    LoadedPoints loaded = load_points(options.load, job);
    options.light.seed = job.options().seed;
    if (!options.sky.empty()) options.light.sky = read_sky(options.sky);
    LightResult light;
    try {
        light = compute_light(loaded.cloud.points, loaded.lights, options.light, job.progress());
    } catch (const UnsupportedInput& error) {
        throw UnsupportedInput(options.load.file + ": " + error.what());
    }
    loaded.cloud.irradiance = std::move(light.irradiance);
    job.warn(light.report.warnings);
    job.tell(fmt::format("{} points, {} patches, {} receivers, {} rays; estimated error {:.2g} mean, {:.2g} p95",
                         loaded.cloud.points.size(), light.report.patches, light.report.receivers, light.report.rays,
                         light.report.error_mean, light.report.error_p95));

    const Stopwatch writing;
    outputs.write(loaded.cloud, loaded.scene, loaded.info, job);
    if (report_file) {
        JobReport report{.input = options.load.file,
                         .points = loaded.cloud.points.size(),
                         .lights = loaded.lights.size(),
                         .area = total_area(loaded.cloud.points),
                         .mean_irradiance = mean_irradiance(loaded.cloud),
                         .seconds = {.import = loaded.import_seconds,
                                     .sample = loaded.sample_seconds,
                                     .tree = light.report.tree_seconds,
                                     .direct = light.report.direct_seconds,
                                     .indirect = light.report.indirect_seconds,
                                     .write = writing.seconds(),
                                     .total = total.seconds()},
                         .light = light.report,
                         .tolerance = options.light.tolerance,
                         .map = std::nullopt,
                         .outputs = outputs.paths()};
        write_report(*report_file, report, job);
    }
    outputs.commit(job, report_file ? &*report_file : nullptr);
}

}  // namespace

Command add_light_command(CLI::App& program) {
    CLI::App* app = program.add_subcommand("light", "Lights a scene as points: the main job");
    app->footer("Example: vmap light room.glb -o lit.ply -o lit.vdb -o lit.png --json report.json");
    auto options = std::make_shared<LightOptions>();
    add_load_options(*app, options->load);
    add_output_options(*app, options->output);
    app->add_option("--tolerance", options->light.tolerance, "Error asked for: mean |dE| over mean E")
        ->type_name("T")
        ->capture_default_str();
    app->add_option("--sky", options->sky,
                    "Light from all around: radiance in W/(m^2 sr), one number or R,G,B; or a panorama (.exr), "
                    "centre along +X, up on top")
        ->type_name("L|FILE");
    app->add_option("--json", options->report, "Writes a report there; - is standard output")->type_name("FILE");
    return {app, [options](Job& job) { run_light(*options, job); }};
}

}  // namespace vmap
