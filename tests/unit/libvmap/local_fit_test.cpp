// SPDX-License-Identifier: GPL-3.0-or-later
#include "local_fit.h"

#include <gtest/gtest.h>

#include <random>

namespace vmap {
namespace {

using Imath::V2f;
using Imath::V3f;

/// A square of side 2 in the plane z = 0 as a grid of points, facing +z.
PointCloud square_cloud(int side) {
    PointCloud cloud;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const float step = 2 / static_cast<float>(side);
            cloud.positions.emplace_back((static_cast<float>(x) + 0.5F) * step - 1,
                                         (static_cast<float>(y) + 0.5F) * step - 1, 0.0F);
            cloud.normals.emplace_back(0.0F, 0.0F, 1.0F);
            cloud.areas.push_back(step * step);
            cloud.albedo.emplace_back(0.5F, 0.5F, 0.5F);
        }
    return cloud;
}

struct Field {
    PointCloud cloud = square_cloud(60);
    Surface surface{cloud};
    std::vector<Receiver> receivers;
    std::vector<ReceiverGrid> grids;

    explicit Field(float cell) { grids.emplace_back(surface, 0U, cell, 0.01F, receivers); }

    template <class Function>
    [[nodiscard]] std::vector<float> values(const Function& of) const {
        std::vector<float> values;
        for (const Receiver& r : receivers) values.insert(values.end(), 3, of(r.place));
        return values;
    }
};

std::vector<V2f> places() {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> uniform(-0.99F, 0.99F);
    std::vector<V2f> result(200);
    for (V2f& place : result) place = {uniform(random), uniform(random)};
    return result;
}

TEST(LocalFit, ReproducesAQuadratic) {
    Field field(0.25F);
    field.grids[0].cut(3, field.receivers);
    const auto quadratic = [](const V2f& p) {
        return 3 + p.x - 2 * p.y + 0.5F * p.x * p.x - p.x * p.y + 2 * p.y * p.y;
    };
    const LocalFit fit(field.surface, field.grids, field.receivers);
    const std::vector<Quadratic> fitted = fit.fit(field.values(quadratic));
    for (const V2f& place : places())
        EXPECT_NEAR(fit.value_at(fit.locate(field.grids[0], place, true), fitted).y, quadratic(place), 2e-4F);
}

TEST(LocalFit, TakesMostOfTheNoiseOut) {
    const Field field(0.1F);
    std::mt19937 random(2);
    std::normal_distribution<float> noise(0, 1);
    const LocalFit fit(field.surface, field.grids, field.receivers);
    const std::vector<Quadratic> fitted = fit.fit(field.values([&](const V2f&) { return noise(random); }));
    double sum = 0;
    for (const V2f& place : places()) {
        const auto value = static_cast<double>(fit.value_at(fit.locate(field.grids[0], place, false), fitted).x);
        sum += value * value;
    }
    EXPECT_LT(std::sqrt(sum / 200), 0.5);
}

TEST(LocalFit, DoesNotReachThroughAWallThatStandsOnThePatch) {
    PointCloud cloud = square_cloud(60);
    // A wall in the plane x = 0.03 from y = -1 to 0.8, seen from both sides; the gap beside it keeps the floor whole.
    for (const float side : {-1.0F, 1.0F})
        for (int y = 0; y < 54; ++y)
            for (int z = 0; z < 15; ++z) {
                const float step = 2.0F / 60;
                cloud.positions.emplace_back(0.03F + side * 1e-3F, (static_cast<float>(y) + 0.5F) * step - 1,
                                             (static_cast<float>(z) + 0.5F) * step);
                cloud.normals.emplace_back(side, 0.0F, 0.0F);
                cloud.areas.push_back(step * step);
                cloud.albedo.emplace_back(0.5F, 0.5F, 0.5F);
            }
    const Surface surface(cloud);
    std::uint32_t floor = 0;
    while (surface.set.patches[floor].normal.z < 0.9F) ++floor;
    std::vector<Receiver> receivers;
    std::vector<ReceiverGrid> grids;
    grids.emplace_back(surface, floor, 0.125F, 0.01F, receivers);
    std::vector<float> values;
    for (const Receiver& r : receivers) values.insert(values.end(), 3, r.position.x < 0.03F ? 1.0F : 0.0F);
    const LocalFit fit(surface, grids, receivers);
    const std::vector<Quadratic> fitted = fit.fit(values);
    const Patch& patch = surface.set.patches[floor];
    for (int row = 0; row < 18; ++row)
        for (const float x : {-0.2F, -0.1F, -0.01F, 0.06F, 0.1F, 0.3F}) {
            const float y = -0.9F + 0.07F * static_cast<float>(row);
            const FieldPlace place = fit.locate(grids[0], patch.to_plane({x, y, 0}), true);
            EXPECT_NEAR(fit.value_at(place, fitted).x, x < 0.03F ? 1 : 0, 1e-3F) << x << ' ' << y;
        }
}

}  // namespace
}  // namespace vmap
