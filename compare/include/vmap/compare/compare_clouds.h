// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How much the light on a cloud differs from that on another one of the same surface.
#pragma once

#include <vmap/compare/difference_figures.h>
#include <vmap/point_cloud.h>

namespace vmap {

struct CloudComparison {
    DifferenceFigures figures;  ///< of irradiance, the mean of the channels
    DifferenceHistogram histogram;
    double mean_distance = 0;  ///< from a point of the reference to its partner, world units
    double spacing = 0;        ///< of the reference's points, world units
};

/// Each point of the reference is compared with the nearest point of the result whose normal differs by less than 60
/// degrees (of the 16 nearest; the nearest where none does), so that the sides of a thin wall keep apart. Points weigh
/// as much as the area they stand for.
///
/// Throws UsageError when a cloud has no points or no irradiance.
[[nodiscard]] CloudComparison compare_clouds(const LitCloud& result, const LitCloud& reference);

}  // namespace vmap
