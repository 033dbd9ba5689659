// SPDX-License-Identifier: GPL-3.0-or-later
#include <vmap/error.h>
#include <vmap/light.h>

#include <gtest/gtest.h>

#include <tbb/global_control.h>

#include <cmath>
#include <numbers>
#include <random>

namespace vmap {
namespace {

using Imath::C3f;
using Imath::V3f;

/// Jittered points of a parallelogram corner + [0,1] a + [0,1] b, facing a x b.
void add_wall(PointCloud& cloud, const V3f& corner, const V3f& a, const V3f& b, int n, float albedo, float emission) {
    std::mt19937 random(static_cast<unsigned>(cloud.size() + 1));
    std::uniform_real_distribution<float> uniform(0, 1);
    const V3f cross = a.cross(b);
    const auto cells = static_cast<float>(n);
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            cloud.positions.push_back(corner + a * ((static_cast<float>(i) + uniform(random)) / cells) +
                                      b * ((static_cast<float>(k) + uniform(random)) / cells));
            cloud.normals.push_back(cross.normalized());
            cloud.areas.push_back(cross.length() / (cells * cells));
            cloud.albedo.emplace_back(albedo);
            cloud.emission.emplace_back(emission);
        }
}

PointCloud closed_box(int n, float albedo, float emission) {
    PointCloud cloud;
    const V3f o(0);
    const V3f x(1, 0, 0);
    const V3f y(0, 1, 0);
    const V3f z(0, 0, 1);
    add_wall(cloud, o, x, y, n, albedo, emission);
    add_wall(cloud, z, y, x, n, albedo, emission);
    add_wall(cloud, o, y, z, n, albedo, emission);
    add_wall(cloud, x, z, y, n, albedo, emission);
    add_wall(cloud, o, z, x, n, albedo, emission);
    add_wall(cloud, y, x, z, n, albedo, emission);
    return cloud;
}

double mean(const std::vector<C3f>& values, std::size_t first, std::size_t last) {
    double sum = 0;
    for (std::size_t i = first; i < last; ++i) sum += static_cast<double>(values[i].x);
    return sum / static_cast<double>(last - first);
}

// L = Le / (1 - albedo) everywhere, hence E = pi (L - Le) / albedo = pi Le / (1 - albedo).
TEST(ComputeLight, FurnaceBoxHasTheSameLightEverywhere) {
    for (const float albedo : {0.2F, 0.5F, 0.8F, 0.95F}) {
        const LightResult result = compute_light(closed_box(40, albedo, 0.1F), {});
        const double expected = std::numbers::pi * 0.1 / (1 - static_cast<double>(albedo));
        EXPECT_TRUE(result.report.converged);
        double worst = 0;
        for (const C3f& e : result.irradiance)
            worst = std::max(worst, std::abs(static_cast<double>(e.x) / expected - 1));
        EXPECT_LT(worst, 0.01) << "albedo " << albedo;
    }
}

// Parallel unit squares at distance 1: F = 0.1998249 (J. R. Howell, catalogue of configuration factors, C-11).
TEST(ComputeLight, ParallelSquaresExchangeTheirFormFactor) {
    PointCloud cloud;
    add_wall(cloud, V3f(0), V3f(1, 0, 0), V3f(0, 1, 0), 40, 0, 1);
    add_wall(cloud, V3f(0, 0, 1), V3f(0, 1, 0), V3f(1, 0, 0), 40, 0, 0);
    const LightResult result = compute_light(cloud, {});
    EXPECT_NEAR(mean(result.irradiance, 1600, 3200) / std::numbers::pi / 0.1998249, 1, 0.005);
}

TEST(ComputeLight, NothingPassesAnOpaqueSheet) {
    PointCloud cloud;
    add_wall(cloud, V3f(0), V3f(1, 0, 0), V3f(0, 1, 0), 40, 0, 1);
    add_wall(cloud, V3f(-1, -1, 0.5F), V3f(3, 0, 0), V3f(0, 3, 0), 90, 0.5F, 0);
    add_wall(cloud, V3f(0, 0, 1), V3f(0, 1, 0), V3f(1, 0, 0), 40, 0.5F, 0);
    const LightResult result = compute_light(cloud, {});
    EXPECT_EQ(mean(result.irradiance, 1600 + 8100, cloud.size()), 0);
}

// E = I cos(t) / d^2.
TEST(ComputeLight, PointLightFollowsTheInverseSquareLaw) {
    PointCloud cloud;
    add_wall(cloud, V3f(-1, -1, 0), V3f(2, 0, 0), V3f(0, 2, 0), 30, 0, 0);
    LightSource light;
    light.position = {0.2, 0.1, 0.7};
    light.intensity = C3f(3);
    const LightResult result = compute_light(cloud, {&light, 1});
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const Imath::V3d way = light.position - Imath::V3d(cloud.positions[i]);
        EXPECT_NEAR(static_cast<double>(result.irradiance[i].x) / (3 * way.z / std::pow(way.length(), 3)), 1, 1e-4);
    }
}

TEST(ComputeLight, SunCastsASharpShadow) {
    PointCloud cloud;
    add_wall(cloud, V3f(-2, -2, 0), V3f(4, 0, 0), V3f(0, 4, 0), 60, 0, 0);
    add_wall(cloud, V3f(-0.5F, -0.5F, 1), V3f(1, 0, 0), V3f(0, 1, 0), 40, 0, 0);
    LightSource sun;
    sun.kind = LightKind::sun;
    sun.direction = {0, 0, -1};
    sun.intensity = C3f(2);
    const LightResult result = compute_light(cloud, {&sun, 1});
    for (std::size_t i = 0; i < 3600; ++i) {
        const V3f& p = cloud.positions[i];
        const float out = std::max(std::abs(p.x), std::abs(p.y)) - 0.5F;
        if (std::abs(out) > 0.02F) {
            EXPECT_EQ(result.irradiance[i].x, out > 0 ? 2.0F : 0.0F);
        }
    }
}

TEST(ComputeLight, OpenGroundUnderASkyGetsPiTimesItsRadiance) {
    PointCloud ground;
    add_wall(ground, V3f(0), V3f(1, 0, 0), V3f(0, 1, 0), 40, 0.5F, 0);
    const LightResult result = compute_light(ground, {}, {.sky = even_sky(C3f(1, 2, 0.5F))});
    for (const C3f& e : result.irradiance)
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(e[c], std::numbers::pi_v<float> * C3f(1, 2, 0.5F)[c], 1e-4F);
}

// A sky that shines from one half only: the half x > 0 of a panorama gives a floor half of what all of it would, and a
// wall that faces it all.
TEST(ComputeLight, APanoramaShinesFromItsSide) {
    constexpr std::size_t width = 600;
    constexpr std::size_t height = 300;
    std::vector<C3f> pixels(width * height, C3f(0));
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = width / 4; x < 3 * width / 4; ++x) pixels[y * width + x] = C3f(2);
    const LightConfig config{.tolerance = 0.0025, .sky = sky_of_panorama(pixels, width, height)};
    EXPECT_EQ(config.sky.width, 256);
    const auto light_on = [&](const V3f& a, const V3f& b) {
        PointCloud square;
        add_wall(square, V3f(0), a, b, 20, 0, 0);
        return static_cast<float>(mean(compute_light(square, {}, config).irradiance, 0, 400)) /
               (2 * std::numbers::pi_v<float>);
    };
    const V3f x(1, 0, 0);
    const V3f y(0, 1, 0);
    const V3f z(0, 0, 1);
    EXPECT_NEAR(light_on(y, z), 1, 0.01F);     // faces +x
    EXPECT_NEAR(light_on(z, y), 0, 0.01F);     // faces -x
    EXPECT_NEAR(light_on(z, x), 0.5F, 0.01F);  // faces up
    EXPECT_NEAR(light_on(x, y), 0.5F, 0.01F);  // faces +z
}

// The sky fills the opening of a black box: E / pi on its floor is the form factor to the lid, 0.199825 for a cube.
TEST(ComputeLight, FloorOfAnOpenBoxSeesTheSkyThroughItsOpening) {
    PointCloud box = closed_box(60, 0, 0);
    const auto lid = static_cast<std::ptrdiff_t>(60 * 60);  // the second wall, at z = 1
    const auto open = [&](auto& values) { values.erase(values.begin() + lid, values.begin() + 2 * lid); };
    open(box.positions);
    open(box.normals);
    open(box.areas);
    open(box.albedo);
    open(box.emission);
    const LightResult result = compute_light(box, {}, {.sky = even_sky(C3f(1))});
    EXPECT_NEAR(mean(result.irradiance, 0, 3600) / std::numbers::pi, 0.199825, 0.001);
}

TEST(ComputeLight, SameBytesAtAnyNumberOfThreads) {
    const PointCloud cloud = closed_box(30, 0.6F, 0.2F);
    const auto lit_by = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return compute_light(cloud, {}).irradiance;
    };
    EXPECT_EQ(lit_by(1), lit_by(8));
}

TEST(ComputeLight, RefusesADarkSceneAndAnImpossibleTolerance) {
    EXPECT_THROW((void)compute_light(closed_box(5, 0.5F, 0), {}), UnsupportedInput);
    EXPECT_THROW((void)compute_light(closed_box(5, 0.5F, 1), {}, {0, 1}), UsageError);
}

}  // namespace
}  // namespace vmap
