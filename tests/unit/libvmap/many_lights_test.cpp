// SPDX-License-Identifier: GPL-3.0-or-later
// Lights that are taken together from afar, against the sum over each of them.
#include <vmap/light.h>
#include <vmap/polygon_light.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace vmap {
namespace {

using Imath::C3f;
using Imath::V3d;
using Imath::V3f;

/// Black floor from -2 to 2 in x and y, facing up.
PointCloud black_floor(int n) {
    PointCloud cloud;
    const float step = 4.0F / static_cast<float>(n);
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            cloud.positions.emplace_back((static_cast<float>(i) + 0.5F) * step - 2,
                                         (static_cast<float>(k) + 0.5F) * step - 2, 0.0F);
            cloud.normals.emplace_back(0.0F, 0.0F, 1.0F);
            cloud.areas.push_back(step * step);
            cloud.albedo.emplace_back(0.0F);
        }
    return cloud;
}

std::vector<LightSource> random_lights(std::size_t count) {
    std::mt19937 random(static_cast<unsigned>(count));
    std::uniform_real_distribution<double> place(-2, 2);
    std::uniform_real_distribution<float> strength(0.1F, 3);
    std::vector<LightSource> lights(count);
    for (LightSource& light : lights) {
        light.position = {place(random), place(random), 1.5 + place(random) / 2};
        light.intensity = C3f(strength(random), strength(random), strength(random));
    }
    return lights;
}

double mean_difference(const std::vector<C3f>& found, const std::vector<C3f>& expected) {
    double difference = 0;
    double sum = 0;
    for (std::size_t i = 0; i < found.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            difference += std::abs(static_cast<double>(found[i][c] - expected[i][c]));
            sum += static_cast<double>(expected[i][c]);
        }
    return difference / sum;
}

TEST(ManyLights, PointLightsAddUp) {
    const PointCloud floor = black_floor(40);
    for (const std::size_t count : {std::size_t{5}, std::size_t{100}, std::size_t{2000}}) {
        const std::vector<LightSource> lights = random_lights(count);
        std::vector<C3f> expected(floor.size(), C3f(0, 0, 0));
        for (std::size_t i = 0; i < floor.size(); ++i)
            for (const LightSource& light : lights) {
                const V3d way = light.position - V3d(floor.positions[i]);
                expected[i] += light.intensity * static_cast<float>(way.z / std::pow(way.length(), 3));
            }
        for (const double tolerance : {0.04, 0.01, 0.0025}) {
            const LightResult result = compute_light(floor, lights, {.tolerance = tolerance});
            EXPECT_LT(mean_difference(result.irradiance, expected), tolerance / 4) << count << " lights";
        }
    }
}

// A lamp with a shade: what hides one light of a cluster hides it in the sum too.
TEST(ManyLights, ThoseBehindASheetAreNotCounted) {
    PointCloud cloud = black_floor(40);
    const std::size_t floor_points = cloud.size();
    // A black sheet at height 0.5 over the half x > 0 of the floor, seen from both sides.
    for (const float side : {-1.0F, 1.0F})
        for (int i = 0; i < 40; ++i)
            for (int k = 0; k < 80; ++k) {
                cloud.positions.emplace_back((static_cast<float>(i) + 0.5F) * 0.05F,
                                             (static_cast<float>(k) + 0.5F) * 0.05F - 2, 0.5F);
                cloud.normals.emplace_back(0.0F, 0.0F, side);
                cloud.areas.push_back(0.0025F);
                cloud.albedo.emplace_back(0.0F);
            }
    const std::vector<LightSource> lights = random_lights(300);
    std::vector<C3f> expected(floor_points, C3f(0, 0, 0));
    for (std::size_t i = 0; i < floor_points; ++i)
        for (const LightSource& light : lights) {
            const V3d from(cloud.positions[i]);
            const V3d way = light.position - from;
            const V3d at_sheet = from + way * (0.5 / way.z);
            if (at_sheet.x > 0 && at_sheet.x < 2 && std::abs(at_sheet.y) < 2) continue;
            expected[i] += light.intensity * static_cast<float>(way.z / std::pow(way.length(), 3));
        }
    LightResult result = compute_light(cloud, lights);
    result.irradiance.resize(floor_points);
    EXPECT_LT(mean_difference(result.irradiance, expected), 0.01);
}

TEST(ManyLights, SmallLampsOfACeilingAddUp) {
    PointCloud cloud = black_floor(40);
    const std::size_t floor_points = cloud.size();
    // 20 x 20 square lamps of 5 x 5 points, 0.05 wide and 0.2 apart, at height 1.5.
    constexpr float step = 0.01F;
    std::vector<std::vector<V3d>> lamps;
    cloud.emission.resize(floor_points, C3f(0, 0, 0));
    for (int i = 0; i < 20; ++i)
        for (int k = 0; k < 20; ++k) {
            const V3f corner(static_cast<float>(i) * 0.2F - 1.9F, static_cast<float>(k) * 0.2F - 1.9F, 1.5F);
            for (int x = 0; x < 5; ++x)
                for (int y = 0; y < 5; ++y) {
                    cloud.positions.push_back(
                        corner + V3f((static_cast<float>(x) + 0.5F) * step, (static_cast<float>(y) + 0.5F) * step, 0));
                    cloud.normals.emplace_back(0.0F, 0.0F, -1.0F);
                    cloud.areas.push_back(step * step);
                    cloud.albedo.emplace_back(0.0F);
                    cloud.emission.emplace_back(1.0F);
                }
            const V3d c(corner);
            lamps.push_back({c, c + V3d(0, 0.05, 0), c + V3d(0.05, 0.05, 0), c + V3d(0.05, 0, 0)});
        }
    std::vector<C3f> expected(floor_points, C3f(0, 0, 0));
    for (std::size_t i = 0; i < floor_points; ++i)
        for (const std::vector<V3d>& lamp : lamps)
            expected[i] += C3f(static_cast<float>(polygon_irradiance(V3d(cloud.positions[i]), V3d(0, 0, 1), lamp)));
    LightResult result = compute_light(cloud, {});
    result.irradiance.resize(floor_points);
    EXPECT_LT(mean_difference(result.irradiance, expected), 0.005);
}

}  // namespace
}  // namespace vmap
