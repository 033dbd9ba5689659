// SPDX-License-Identifier: GPL-3.0-or-later
#include "report.h"

#include <vmap/printable.h>
#include <vmap/version.h>

#include <sys/resource.h>
#include <tbb/global_control.h>
#include <nlohmann/json.hpp>

namespace vmap {
namespace {

using Json = nlohmann::ordered_json;

Json seconds_of(const StageSeconds& s) {
    return {{"import", s.import}, {"sample", s.sample},     {"tree", s.tree},   {"vmap", s.vmap},
            {"direct", s.direct}, {"indirect", s.indirect}, {"write", s.write}, {"total", s.total}};
}

}  // namespace

std::size_t peak_memory() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

void write_report(FileWriter& file, const JobReport& report, const Job& job) {
    const LightReport light = report.light.value_or(LightReport{});
    const MapCounts map = report.map.value_or(MapCounts{light.nodes, light.leaves, light.patches, 0});
    Json json{{"version", version},
              {"input", printable(report.input)},
              {"seed", job.options().seed},
              {"threads", tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism)},
              {"points", report.points},
              {"area", report.area},
              {"nodes", map.nodes},
              {"leaves", map.leaves},
              {"patches", map.patches},
              {"links", map.links},
              {"lights", report.lights},
              {"seconds", seconds_of(report.seconds)}};
    if (report.light) {
        json["tolerance"] = report.tolerance;
        json["error_estimate"] = {{"mean", light.error_mean}, {"p95", light.error_p95}};
        json["mean_irradiance"] = report.mean_irradiance;
        json["receivers"] = light.receivers;
        json["rays"] = light.rays;
        json["converged"] = light.converged;
    }
    json["peak_memory_bytes"] = peak_memory();
    json["warnings"] = job.warnings();
    json["outputs"] = Json::array();
    for (const std::string& output : report.outputs) json["outputs"].push_back(printable(output));
    file.stream() << json.dump(1, ' ', false, Json::error_handler_t::replace) << '\n';
}

}  // namespace vmap
