// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How far a result is from the truth, in the figures that the documentation defines.
#pragma once

#include <cstddef>
#include <span>

namespace vmap::reference {

/// Differences are of the mean of the channels. All but the first are divided by the weighted mean of the truth.
struct ErrorFigures {
    std::size_t points = 0;
    double mean_truth = 0;  ///< W/m^2
    double ratio = 0;       ///< weighted mean of the result
    double error = 0;       ///< weighted mean of |result - truth|
    double p50 = 0;         ///< half of the weight differs by less
    double p95 = 0;
    double p99 = 0;
    double largest = 0;
    double noise = 0;  ///< weighted mean of the truth's standard error: what a perfect result would show, about
};

/// - result, truth, standard_errors (of the truth): one value per point
/// - weights: the area that each point stands for; points of weight 0 do not count
[[nodiscard]] ErrorFigures error_figures(std::span<const double> result, std::span<const double> truth,
                                         std::span<const double> standard_errors, std::span<const double> weights);

}  // namespace vmap::reference
