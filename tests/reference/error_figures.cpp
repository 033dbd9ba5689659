// SPDX-License-Identifier: GPL-3.0-or-later
#include <reference/error_figures.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace vmap::reference {
namespace {

/// Smallest difference that at least this share of the weight does not exceed.
double percentile(const std::vector<std::pair<double, double>>& sorted, double total, double share) {
    double sum = 0;
    for (const auto& [difference, weight] : sorted) {
        sum += weight;
        if (sum >= share * total) return difference;
    }
    return sorted.back().first;
}

}  // namespace

ErrorFigures error_figures(std::span<const double> result, std::span<const double> truth,
                           std::span<const double> standard_errors, std::span<const double> weights) {
    ErrorFigures figures;
    std::vector<std::pair<double, double>> differences;
    double total = 0;
    double result_sum = 0;
    double truth_sum = 0;
    double difference_sum = 0;
    double noise_sum = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        if (!(weights[i] > 0)) continue;
        const double difference = std::abs(result[i] - truth[i]);
        differences.emplace_back(difference, weights[i]);
        total += weights[i];
        result_sum += weights[i] * result[i];
        truth_sum += weights[i] * truth[i];
        difference_sum += weights[i] * difference;
        noise_sum += weights[i] * standard_errors[i];
    }
    figures.points = differences.size();
    if (differences.empty()) return figures;

    std::sort(differences.begin(), differences.end());
    figures.mean_truth = truth_sum / total;
    figures.ratio = result_sum / truth_sum;
    figures.error = difference_sum / truth_sum;
    figures.noise = noise_sum / truth_sum;
    figures.p50 = percentile(differences, total, 0.50) / figures.mean_truth;
    figures.p95 = percentile(differences, total, 0.95) / figures.mean_truth;
    figures.p99 = percentile(differences, total, 0.99) / figures.mean_truth;
    figures.largest = differences.back().first / figures.mean_truth;
    return figures;
}

}  // namespace vmap::reference
