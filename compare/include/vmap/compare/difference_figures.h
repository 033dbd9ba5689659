// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How much two sets of values differ.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace vmap {

/// Everything but the first two is a fraction of mean_reference (of 1 where that is 0).
struct DifferenceFigures {
    std::size_t count = 0;      ///< of values with a weight
    double mean_reference = 0;  ///< weighted
    double mean = 0;            ///< weighted mean of the differences
    double median = 0;          ///< half of the weight differs by no more
    double p95 = 0;
    double p99 = 0;
    double largest = 0;
    double rmse = 0;  ///< root of the weighted mean of their squares
    double bias = 0;  ///< signed: weighted mean of the result minus that of the reference
};

/// - difference: one value per element, never negative
/// - result, reference: the values themselves, for the bias
/// - weights: of the elements; empty: all equal. Elements of weight 0 do not count.
[[nodiscard]] DifferenceFigures difference_figures(std::span<const double> difference, std::span<const double> result,
                                                   std::span<const double> reference,
                                                   std::span<const double> weights = {});

/// Shares of the weight whose difference, as a fraction of the mean of the reference, lies between bounds.
struct DifferenceHistogram {
    std::vector<double> bounds;  ///< ascending, one more than shares
    std::vector<double> shares;  ///< the first holds what is less than bounds.front() too, the last what is more
};

/// - bins: equal steps of the logarithm from 1e-5 to 1
[[nodiscard]] DifferenceHistogram difference_histogram(std::span<const double> difference, double mean_reference,
                                                       std::span<const double> weights = {}, int bins = 50);

}  // namespace vmap
