// SPDX-License-Identifier: GPL-3.0-or-later
#include <reference/error_figures.h>

#include <gtest/gtest.h>

#include <vector>

namespace vmap::reference {
namespace {

TEST(ErrorFigures, DifferencesAreRelativeToTheMeanTruth) {
    const std::vector<double> truth{1, 3, 2, 2};
    const std::vector<double> result{1.2, 3, 2, 1.6};
    const std::vector<double> errors{0.1, 0.1, 0.1, 0.1};
    const std::vector<double> weights{1, 1, 1, 1};
    const ErrorFigures figures = error_figures(result, truth, errors, weights);
    EXPECT_EQ(figures.points, 4U);
    EXPECT_DOUBLE_EQ(figures.mean_truth, 2);
    EXPECT_DOUBLE_EQ(figures.ratio, 7.8 / 8);
    EXPECT_NEAR(figures.error, 0.6 / 8, 1e-12);
    EXPECT_NEAR(figures.p50, 0, 1e-12);
    EXPECT_NEAR(figures.p95, 0.2, 1e-12);
    EXPECT_NEAR(figures.largest, 0.2, 1e-12);
    EXPECT_NEAR(figures.noise, 0.05, 1e-12);
}

TEST(ErrorFigures, PercentilesCountArea) {
    const std::vector<double> truth(3, 1.0);
    const std::vector<double> result{1.0, 1.1, 1.5};
    const std::vector<double> errors(3, 0.0);
    EXPECT_NEAR(error_figures(result, truth, errors, std::vector<double>{90, 8, 2}).p95, 0.1, 1e-12);
    EXPECT_NEAR(error_figures(result, truth, errors, std::vector<double>{90, 8, 2}).p99, 0.5, 1e-12);
    EXPECT_NEAR(error_figures(result, truth, errors, std::vector<double>{2, 8, 90}).p50, 0.5, 1e-12);
}

TEST(ErrorFigures, PointsWithoutWeightDoNotCount) {
    const std::vector<double> truth{1, 1};
    const std::vector<double> result{1, 9};
    const std::vector<double> errors{0, 0};
    const ErrorFigures figures = error_figures(result, truth, errors, std::vector<double>{1, 0});
    EXPECT_EQ(figures.points, 1U);
    EXPECT_EQ(figures.largest, 0);
    EXPECT_EQ(error_figures(result, truth, errors, std::vector<double>{0, 0}).points, 0U);
}

}  // namespace
}  // namespace vmap::reference
