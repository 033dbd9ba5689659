// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Points that a file holds, made complete when they are raw.
#pragma once

#include "job.h"

#include <vmap/importers/input.h>
#include <vmap/importers/prepare_cloud.h>
#include <vmap/light_source.h>

#include <span>
#include <string>

namespace vmap {

struct RawPointOptions {
    std::string viewpoint;                  ///< --viewpoint, not yet parsed
    CloudSide side = CloudSide::automatic;  ///< --orient
};

/// --viewpoint and --orient.
void add_raw_point_options(CLI::App& app, RawPointOptions& options);

/// Complete points of a file. What had to be estimated is said as warnings.
///
/// - input: holds points
/// - lights: that will shine on them, world
/// - throws UsageError for a bad viewpoint, UnsupportedInput for points that are no surface
[[nodiscard]] PointFile complete_points(Input input, const std::string& file, const RawPointOptions& options,
                                        std::span<const LightSource> lights, Job& job);

}  // namespace vmap
