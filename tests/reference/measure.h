// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A lit cloud against the path-traced truth of the scene that it was sampled from.
#pragma once

#include <reference/error_figures.h>
#include <reference/lit_ply.h>
#include <reference/reference_tracer.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace vmap::reference {

struct MeasureConfig {
    std::size_t points = 2000;           ///< how many are looked at, drawn by area; all when the cloud has no more
    std::size_t samples = 0;             ///< paths per point; 0: as many as the noise asks for
    double noise = 0.002;                ///< mean standard error / mean of the truth, asked for when samples is 0
    bool away_from_silhouettes = false;  ///< also without the points near which the truth changes
    int max_bounces = ReferenceConfig::all_bounces;
    std::uint64_t seed = 1;
    std::filesystem::path cache;  ///< folder that keeps truths; none when empty
};

struct Measurement {
    ErrorFigures all;
    ErrorFigures away;        ///< from silhouettes, when asked for
    double left_out = 0;      ///< share of the area that `away` leaves out
    std::size_t samples = 0;  ///< paths per point that were spent
};

/// Compares the irradiance of a cloud's points with the truth at the same points.
///
/// A point is near a silhouette when the truth changes by more than a tenth of its mean (and three standard errors)
/// as the point moves by one spacing, the root of the mean area, in its plane along either of two axes.
///
/// Throws UnsupportedInput when the cloud is empty or has no area.
[[nodiscard]] Measurement measure(const Scene& scene, const LitPly& cloud, const MeasureConfig& config,
                                  const ProgressCallback& progress = {});

}  // namespace vmap::reference
