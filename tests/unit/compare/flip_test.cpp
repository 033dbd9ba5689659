// SPDX-License-Identifier: GPL-3.0-or-later
#include <vmap/compare/flip.h>
#include <vmap/error.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vmap {
namespace {

using Imath::C3f;

constexpr int width = 64;
constexpr int height = 48;

template <class F>
Picture picture_of(const F& color) {
    Picture picture{.width = width, .height = height};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) picture.pixels.push_back(color(x, y));
    return picture;
}

C3f waves(int x, int y) {
    return {static_cast<float>(0.5 + 0.4 * std::sin(0.3 * x)), static_cast<float>(0.5 + 0.4 * std::cos(0.2 * y)),
            static_cast<float>(0.5 + 0.4 * std::sin(0.1 * (x + y)))};
}

/// The waves with a faint board of squares, one white pixel and a black hole.
C3f disturbed_waves(int x, int y) {
    C3f color = waves(x, y);
    if ((x / 8 + y / 8) % 2 == 0) color.x = std::min(1.0F, color.x + 0.05F);
    if (x == 20 && y == 20) color = {1, 1, 1};
    if (y >= 30 && y < 33 && x >= 40 && x < 44) color = {0, 0, 0};
    return color;
}

/// The same with a range of e^4.
C3f bright(const C3f& color) {
    return {std::exp(4 * color.x - 2), std::exp(4 * color.y - 2), std::exp(4 * color.z - 2)};
}

float at(const std::vector<float>& map, int x, int y) {
    return map[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)];
}

double mean_of(const std::vector<float>& map) {
    return std::accumulate(map.begin(), map.end(), 0.0) / static_cast<double>(map.size());
}

// Expected values: the authors' program, flip-evaluator 1.7, on the same numbers (inputsRGB=False, applyMagma=False).
TEST(Flip, AgreesWithTheAuthorsProgramOnDisplayValues) {
    const std::vector<float> map = flip_map(picture_of(disturbed_waves), picture_of(waves), FlipRange::display);
    EXPECT_NEAR(mean_of(map), 0.09463062, 2e-5);
    EXPECT_NEAR(at(map, 20, 20), 0.36285225, 2e-4);
    EXPECT_NEAR(at(map, 42, 31), 0.9689237, 2e-4);
    EXPECT_NEAR(at(map, 0, 0), 0.12347981, 2e-4);
    EXPECT_NEAR(at(map, 32, 24), 0.08031883, 2e-4);
}

TEST(Flip, AgreesWithTheAuthorsProgramOnRadiance) {
    const std::vector<float> map =
        flip_map(picture_of([](int x, int y) { return bright(disturbed_waves(x, y)); }),
                 picture_of([](int x, int y) { return bright(waves(x, y)); }), FlipRange::high);
    EXPECT_NEAR(mean_of(map), 0.10134184, 2e-5);
    EXPECT_NEAR(at(map, 20, 20), 0.46836162, 2e-4);
    EXPECT_NEAR(at(map, 42, 31), 0.9658646, 2e-4);
    EXPECT_NEAR(at(map, 0, 0), 0.17271505, 2e-4);
    EXPECT_NEAR(at(map, 32, 24), 0.10463631, 2e-4);
}

TEST(Flip, EqualPicturesDoNotDiffer) {
    for (const FlipRange range : {FlipRange::display, FlipRange::high}) {
        const std::vector<float> map = flip_map(picture_of(waves), picture_of(waves), range);
        EXPECT_EQ(*std::max_element(map.begin(), map.end()), 0);
    }
}

TEST(Flip, BlackAgainstWhiteIsNearlyOneAndBlackPicturesAreNoTrouble) {
    const Picture black = picture_of([](int, int) { return C3f(0, 0, 0); });
    const Picture white = picture_of([](int, int) { return C3f(1, 1, 1); });
    EXPECT_GT(mean_of(flip_map(black, white, FlipRange::display)), 0.95);
    EXPECT_EQ(mean_of(flip_map(black, black, FlipRange::high)), 0);
    EXPECT_GT(mean_of(flip_map(white, black, FlipRange::high)), 0.5);
}

TEST(Flip, PicturesOfDifferentSizesAreRefused) {
    EXPECT_THROW((void)flip_map({.width = 1, .height = 2, .pixels = std::vector<C3f>(2)},
                                {.width = 2, .height = 1, .pixels = std::vector<C3f>(2)}, FlipRange::display),
                 UsageError);
    EXPECT_TRUE(flip_map({}, {}, FlipRange::display).empty());
}

}  // namespace
}  // namespace vmap
