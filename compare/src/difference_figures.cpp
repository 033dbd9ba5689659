// SPDX-License-Identifier: GPL-3.0-or-later
#include <vmap/compare/difference_figures.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace vmap {
namespace {

constexpr double smallest_bound = 1e-5;

double weight_at(std::span<const double> weights, std::size_t i) {
    return weights.empty() ? 1 : weights[i];
}

/// What differences are divided by.
double scale_of(double mean_reference) {
    return mean_reference > 0 ? mean_reference : 1;
}

/// Smallest value that at least this share of the weight does not exceed.
double percentile(const std::vector<std::pair<double, double>>& sorted, double total, double share) {
    double sum = 0;
    for (const auto& [value, weight] : sorted) {
        sum += weight;
        if (sum >= share * total) return value;
    }
    return sorted.back().first;
}

}  // namespace

DifferenceFigures difference_figures(std::span<const double> difference, std::span<const double> result,
                                     std::span<const double> reference, std::span<const double> weights) {
    std::vector<std::pair<double, double>> sorted;
    double total = 0;
    double result_sum = 0;
    double reference_sum = 0;
    double sum = 0;
    double squares = 0;
    for (std::size_t i = 0; i < difference.size(); ++i) {
        const double weight = weight_at(weights, i);
        if (!(weight > 0)) continue;
        sorted.emplace_back(difference[i], weight);
        total += weight;
        result_sum += weight * result[i];
        reference_sum += weight * reference[i];
        sum += weight * difference[i];
        squares += weight * difference[i] * difference[i];
    }
    DifferenceFigures figures;
    figures.count = sorted.size();
    if (sorted.empty()) return figures;

    std::sort(sorted.begin(), sorted.end());
    figures.mean_reference = reference_sum / total;
    const double scale = scale_of(figures.mean_reference);
    figures.mean = sum / total / scale;
    figures.median = percentile(sorted, total, 0.50) / scale;
    figures.p95 = percentile(sorted, total, 0.95) / scale;
    figures.p99 = percentile(sorted, total, 0.99) / scale;
    figures.largest = sorted.back().first / scale;
    figures.rmse = std::sqrt(squares / total) / scale;
    figures.bias = (result_sum - reference_sum) / total / scale;
    return figures;
}

DifferenceHistogram difference_histogram(std::span<const double> difference, double mean_reference,
                                         std::span<const double> weights, int bins) {
    DifferenceHistogram histogram;
    for (int i = 0; i <= bins; ++i)
        histogram.bounds.push_back(smallest_bound * std::pow(1 / smallest_bound, static_cast<double>(i) / bins));
    histogram.shares.assign(static_cast<std::size_t>(bins), 0);
    double total = 0;
    const double scale = scale_of(mean_reference);
    for (std::size_t i = 0; i < difference.size(); ++i) {
        const double weight = weight_at(weights, i);
        if (!(weight > 0)) continue;
        const auto above = std::upper_bound(histogram.bounds.begin(), histogram.bounds.end(), difference[i] / scale);
        const auto bin = std::clamp<std::ptrdiff_t>(above - histogram.bounds.begin() - 1, 0, bins - 1);
        histogram.shares[static_cast<std::size_t>(bin)] += weight;
        total += weight;
    }
    for (double& share : histogram.shares) share = total > 0 ? share / total : 0;
    return histogram;
}

}  // namespace vmap
