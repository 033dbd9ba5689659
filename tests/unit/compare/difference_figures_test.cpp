// SPDX-License-Identifier: GPL-3.0-or-later
#include <vmap/compare/difference_figures.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

namespace vmap {
namespace {

TEST(DifferenceFigures, AreFractionsOfTheMeanOfTheReference) {
    const std::vector<double> reference{1, 3, 2, 2};
    const std::vector<double> result{1.2, 3, 2, 1.6};
    const std::vector<double> difference{0.2, 0, 0, 0.4};
    const DifferenceFigures figures = difference_figures(difference, result, reference);
    EXPECT_EQ(figures.count, 4U);
    EXPECT_DOUBLE_EQ(figures.mean_reference, 2);
    EXPECT_NEAR(figures.mean, 0.15 / 2, 1e-12);
    EXPECT_NEAR(figures.median, 0, 1e-12);
    EXPECT_NEAR(figures.p95, 0.2, 1e-12);
    EXPECT_NEAR(figures.largest, 0.2, 1e-12);
    EXPECT_NEAR(figures.rmse, std::sqrt((0.04 + 0.16) / 4) / 2, 1e-12);
    EXPECT_NEAR(figures.bias, -0.05 / 2, 1e-12);
}

TEST(DifferenceFigures, WeightsCountAsRepetitions) {
    const std::vector<double> reference{1, 1, 1};
    const std::vector<double> result{1.1, 1.5, 9};
    const std::vector<double> difference{0.1, 0.5, 8};
    const DifferenceFigures figures = difference_figures(difference, result, reference, std::vector<double>{98, 2, 0});
    EXPECT_EQ(figures.count, 2U);
    EXPECT_NEAR(figures.mean, 0.108, 1e-12);
    EXPECT_NEAR(figures.p95, 0.1, 1e-12);
    EXPECT_NEAR(figures.p99, 0.5, 1e-12);
}

TEST(DifferenceFigures, ADarkReferenceLeavesThemAbsolute) {
    const std::vector<double> zero{0, 0};
    const std::vector<double> result{0.5, 0};
    EXPECT_NEAR(difference_figures(result, result, zero).mean, 0.25, 1e-12);
    EXPECT_EQ(difference_figures({}, {}, {}).count, 0U);
}

TEST(DifferenceHistogram, SharesSumToOneAndStandWhereTheyBelong) {
    const std::vector<double> difference{0, 2e-3, 2e-3, 50};
    const DifferenceHistogram histogram = difference_histogram(difference, 2);
    EXPECT_NEAR(std::accumulate(histogram.shares.begin(), histogram.shares.end(), 0.0), 1, 1e-12);
    EXPECT_EQ(histogram.shares.front(), 0.25);
    EXPECT_EQ(histogram.shares.back(), 0.25);
    for (std::size_t i = 0; i < histogram.shares.size(); ++i)
        if (histogram.shares[i] == 0.5) {
            EXPECT_LE(histogram.bounds[i], 1e-3 * (1 + 1e-9));
            EXPECT_GE(histogram.bounds[i + 1], 1e-3);
        }
}

}  // namespace
}  // namespace vmap
