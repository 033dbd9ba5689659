// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The report of a job as one JSON object, SI units and seconds.
#pragma once

#include "job.h"

#include <vmap/exporters/file_writer.h>
#include <vmap/light.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace vmap {

struct StageSeconds {
    double import = 0;
    double sample = 0;
    double tree = 0;
    double vmap = 0;
    double direct = 0;
    double indirect = 0;
    double write = 0;
    double total = 0;
};

/// Of a visibility map.
struct MapCounts {
    std::size_t nodes = 0;
    std::size_t leaves = 0;
    std::size_t patches = 0;
    std::size_t links = 0;  ///< ordered pairs
};

struct JobReport {
    std::string input;
    std::size_t points = 0;
    std::size_t lights = 0;
    double area = 0;             ///< lit sides, world units squared
    double mean_irradiance = 0;  ///< area-weighted mean of the channels' mean, W/m^2
    StageSeconds seconds{};
    std::optional<LightReport> light;  ///< of jobs that lit something
    double tolerance = 0;
    std::optional<MapCounts> map;  ///< of jobs that built one
    std::vector<std::string> outputs;
};

/// The largest amount of memory that the process has had, bytes.
[[nodiscard]] std::size_t peak_memory();

/// Writes the object and a line break. Numbers that are not finite are null.
void write_report(FileWriter& file, const JobReport& report, const Job& job);

}  // namespace vmap
