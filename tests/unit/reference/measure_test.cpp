// SPDX-License-Identifier: GPL-3.0-or-later
#include <reference/measure.h>
#include <reference/reference_cache.h>
#include <vmap/error.h>

#include "room_builder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <vector>

namespace vmap::reference {
namespace {

using Imath::V3d;
using std::numbers::pi;
using test::grey;
using test::matte;
using test::RoomBuilder;

/// A floor of 2 x 2 under a sun from straight above, of which a plate hides the half with x > 0; dark otherwise.
Scene half_shaded_floor() {
    LightSource sun;
    sun.kind = LightKind::sun;
    sun.direction = {0, -1, 0};
    sun.intensity = grey(2);
    return RoomBuilder()
        .quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, matte(grey(0)))
        .quad({0, 1, -2}, {0, 0, 4}, {4, 0, 0}, matte(grey(0)))
        .light(sun)
        .scene();
}

/// count x count points on that floor with a given irradiance in the light; the shade is dark.
LitPly points_on_floor(int count, float irradiance) {
    LitPly cloud;
    for (int x = 0; x < count; ++x)
        for (int z = 0; z < count; ++z) {
            const V3d position(-1 + 2 * (x + 0.5) / count, 0, -1 + 2 * (z + 0.5) / count);
            cloud.positions.push_back(position);
            cloud.normals.emplace_back(0, 1, 0);
            cloud.irradiance.push_back(grey(position.x < 0 ? irradiance : 0.0F));
            cloud.areas.push_back(4.0 / (count * count));
            cloud.faces.push_back(x + z < count ? 0U : 1U);
        }
    return cloud;
}

TEST(Measure, PerfectResultHasNoError) {
    const Measurement found = measure(half_shaded_floor(), points_on_floor(20, 2), {});
    EXPECT_EQ(found.all.points, 400U);
    EXPECT_NEAR(found.all.mean_truth, 1, 1e-6);
    EXPECT_NEAR(found.all.ratio, 1, 1e-6);
    EXPECT_NEAR(found.all.error, 0, 1e-6);
}

TEST(Measure, ErrorIsRelativeToTheMeanOverAllPoints) {
    MeasureConfig config;
    config.samples = 16;
    const Measurement found = measure(half_shaded_floor(), points_on_floor(20, 2.2F), config);
    EXPECT_NEAR(found.all.ratio, 1.1, 1e-6);
    EXPECT_NEAR(found.all.error, 0.1, 1e-6);
    EXPECT_NEAR(found.all.p95, 0.2, 1e-6);
    EXPECT_EQ(found.samples, 16U);
}

TEST(Measure, SubsetIsDrawnByArea) {
    LitPly cloud = points_on_floor(20, 2.2F);
    for (std::size_t i = 0; i < cloud.size(); ++i)
        if (cloud.positions[i].x > 0) cloud.areas[i] *= 3;
    MeasureConfig config;
    config.points = 100;
    config.samples = 16;
    const Measurement found = measure(half_shaded_floor(), cloud, config);
    EXPECT_LE(found.all.points, 100U);
    EXPECT_NEAR(found.all.mean_truth, 2 * 0.25, 0.02);
}

TEST(Measure, SamplesAreSpentUntilTheNoiseIsLow) {
    const Scene scene = RoomBuilder().room({-1, 0, -1}, {1, 1, 1}, matte(grey(0.5F), grey(0.5F))).scene();
    MeasureConfig config;
    config.points = 50;
    config.noise = 0.004;
    const Measurement found = measure(scene, points_on_floor(20, static_cast<float>(pi)), config);
    EXPECT_GT(found.samples, 256U);
    EXPECT_LE(found.all.noise, 0.004);
    EXPECT_GT(found.all.noise, 0.0005);
}

TEST(Measure, PointsWithinOneSpacingOfAShadowEdgeAreLeftOut) {
    LitPly cloud = points_on_floor(20, 2);
    // A blurred edge: the two columns beside it are half lit.
    for (std::size_t i = 0; i < cloud.size(); ++i)
        if (std::abs(cloud.positions[i].x) < 0.1) cloud.irradiance[i] = grey(1);
    MeasureConfig config;
    config.samples = 16;
    config.away_from_silhouettes = true;
    const Measurement found = measure(half_shaded_floor(), cloud, config);
    EXPECT_NEAR(found.all.error, 0.1, 1e-6);
    EXPECT_NEAR(found.left_out, 0.1, 0.051) << "the columns beside the shadow's edge";
    EXPECT_NEAR(found.away.error, 0, 1e-6);
}

TEST(Measure, CloudWithoutAreaIsRefused) {
    EXPECT_THROW((void)measure(half_shaded_floor(), {}, {}), UnsupportedInput);
}

class Cache : public testing::Test {
protected:
    void SetUp() override { std::filesystem::remove_all(folder); }
    void TearDown() override { std::filesystem::remove_all(folder); }

    [[nodiscard]] std::vector<std::filesystem::path> files() const {
        std::vector<std::filesystem::path> found;
        for (const auto& entry : std::filesystem::directory_iterator(folder)) found.push_back(entry.path());
        return found;
    }

    std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "reference_cache_test";
    std::vector<ReferencePoint> points{{.position = {-0.5, 0, 0.1}, .normal = {0, 1, 0}}};
    ReferenceConfig config{.samples = 16};
};

TEST_F(Cache, SameQuestionIsAnsweredFromTheFile) {
    const Scene scene = half_shaded_floor();
    const auto traced = cached_irradiance(folder, scene, points, config);
    ASSERT_EQ(files().size(), 1U);
    // A file that holds something else proves that it was read.
    std::vector<float> other{7, 7, 7, 0, 0, 0, 0};
    std::ofstream(files().front(), std::ios::binary)
        .write(reinterpret_cast<const char*>(other.data()), static_cast<std::streamsize>(other.size() * sizeof(float)));
    EXPECT_EQ(cached_irradiance(folder, scene, points, config).front().irradiance, grey(7));
    EXPECT_EQ(traced.front().irradiance, grey(2));
}

TEST_F(Cache, ChangedSceneOrQuestionIsTracedAnew) {
    Scene scene = half_shaded_floor();
    (void)cached_irradiance(folder, scene, points, config);
    scene.lights[0].intensity = grey(3);
    EXPECT_EQ(cached_irradiance(folder, scene, points, config).front().irradiance, grey(3));
    scene.materials[0].base_color.r = 0.5F;
    (void)cached_irradiance(folder, scene, points, config);
    config.seed = 2;
    (void)cached_irradiance(folder, scene, points, config);
    EXPECT_EQ(files().size(), 4U);
}

TEST_F(Cache, BrokenFileIsMadeAnew) {
    const Scene scene = half_shaded_floor();
    (void)cached_irradiance(folder, scene, points, config);
    std::filesystem::resize_file(files().front(), 5);
    EXPECT_EQ(cached_irradiance(folder, scene, points, config).front().irradiance, grey(2));
    EXPECT_EQ(std::filesystem::file_size(files().front()), 28U);
}

}  // namespace
}  // namespace vmap::reference
