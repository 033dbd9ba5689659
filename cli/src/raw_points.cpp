// SPDX-License-Identifier: GPL-3.0-or-later
#include "raw_points.h"

#include "choice.h"
#include "parse_values.h"

#include <vmap/axes.h>
#include <vmap/error.h>

#include <fmt/format.h>

#include <map>
#include <optional>
#include <utility>

namespace vmap {

void add_raw_point_options(CLI::App& app, RawPointOptions& options) {
    auto* viewpoint =
        app.add_option("--viewpoint", options.viewpoint,
                       "Points without normals: the place that all were seen from, in the axes of the file")
            ->type_name("X,Y,Z");
    app.add_option(
           "--orient", options.side,
           "Points without normals: the side they face; mst turns the topmost points upwards, auto is inward for "
           "what surrounds a light or looks like a room, else outward")
        ->transform(choice(std::map<std::string, CloudSide>{{"auto", CloudSide::automatic},
                                                            {"mst", CloudSide::topmost},
                                                            {"inward", CloudSide::inward},
                                                            {"outward", CloudSide::outward}}))
        ->excludes(viewpoint)
        ->type_name("auto|mst|inward|outward")
        ->default_str("auto");
}

PointFile complete_points(Input input, const std::string& file, const RawPointOptions& options,
                          std::span<const LightSource> lights, Job& job) {
    PrepareConfig config{.side = options.side, .viewpoint = std::nullopt, .lights = lights};
    if (!options.viewpoint.empty())
        config.viewpoint = world_from_file(input.facts.up, parse_vector("--viewpoint", options.viewpoint));
    PointFile points = std::move(*input.points);
    if (is_complete(points.cloud.points)) return points;
    PrepareReport report;
    try {
        prepare_cloud(points.cloud, config, &report, job.progress());
    } catch (const UnsupportedInput& error) {
        throw UnsupportedInput(file + ": " + error.what());
    }
    job.warn(report.warnings);
    job.tell(fmt::format("{} points, {:.4g} apart, {:.4g} off a smooth surface, area {:.6g}",
                         points.cloud.points.size(), report.spacing, report.noise, report.area));
    return points;
}

}  // namespace vmap
