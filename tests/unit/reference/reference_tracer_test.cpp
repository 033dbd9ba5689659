// SPDX-License-Identifier: GPL-3.0-or-later
#include <reference/reference_tracer.h>
#include <vmap/surface_shading.h>

#include "room_builder.h"
#include "surface_points.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

namespace vmap::reference {
namespace {

using Imath::C3f;
using Imath::V3d;
using Imath::V3f;
using std::numbers::pi;
using test::face_of;
using test::grey;
using test::matte;
using test::points_on;
using test::RoomBuilder;

constexpr float far = 1000;

std::vector<ReferenceValue> trace(const Scene& scene, const std::vector<ReferencePoint>& points,
                                  const ReferenceConfig& config = {}) {
    return trace_irradiance(scene, points, config);
}

ReferenceValue trace_one(const Scene& scene, const V3d& position, const V3d& normal,
                         const ReferenceConfig& config = {}) {
    return trace(scene, {{.position = position, .normal = normal}}, config).front();
}

LightSource sun(const V3d& direction, float irradiance) {
    LightSource source;
    source.kind = LightKind::sun;
    source.direction = direction;
    source.intensity = grey(irradiance);
    return source;
}

LightSource point_light(const V3d& position, const C3f& intensity) {
    LightSource source;
    source.kind = LightKind::point;
    source.position = position;
    source.intensity = intensity;
    return source;
}

/// Middles of count x count cells of a square in x and z.
std::vector<ReferencePoint> grid_of_points(const V3d& corner, double size, int count, const V3d& normal) {
    std::vector<ReferencePoint> points;
    points.reserve(static_cast<std::size_t>(count) * static_cast<std::size_t>(count));
    for (int x = 0; x < count; ++x)
        for (int z = 0; z < count; ++z)
            points.push_back({.position = corner + V3d(x + 0.5, 0, z + 0.5) * (size / count), .normal = normal});
    return points;
}

/// Power that the fronts emit, first channel.
double emitted_power(const Scene& scene) {
    double sum = 0;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
        for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
            sum += pi * scene.materials[mesh.material].emission.x * world_area_normal(scene, i, t).length() / 2;
    }
    return sum;
}

TEST(ReferenceTracer, FurnaceHasTheSameLightEverywhere) {
    for (const float albedo : {0.0F, 0.5F, 0.8F, 0.99F}) {
        const float emission = 1 - albedo;
        const Scene scene = RoomBuilder().room({-1, -1, -1}, {1, 1, 1}, matte(grey(albedo), grey(emission))).scene();
        double area = 0;
        for (const ReferenceValue& value : trace(scene, points_on(scene, 60, area), {.samples = 256})) {
            // MIS of a uniform furnace at a corner has the largest scatter; five errors are a safe bound for 60 points.
            EXPECT_NEAR(value.irradiance.x, pi, 5.5 * value.standard_error.x + 1e-6) << "albedo " << albedo;
            EXPECT_LT(value.standard_error.x, 0.1);
        }
    }
}

TEST(ReferenceTracer, BouncesOfAFurnaceAreTheTermsOfAGeometricSeries) {
    const Scene scene = RoomBuilder().room({-1, -1, -1}, {1, 1, 1}, matte(grey(0.5F), grey(0.5F))).scene();
    double expected = 0;
    for (int bounces = 0; bounces < 4; ++bounces) {
        expected += pi * 0.5 * std::pow(0.5, bounces);
        const ReferenceValue value =
            trace_one(scene, {0.2, -1, 0.3}, {0, 1, 0}, {.samples = 4096, .max_bounces = bounces});
        EXPECT_NEAR(value.irradiance.x, expected, 5 * value.standard_error.x) << bounces << " bounces";
        EXPECT_LT(value.standard_error.x, 0.01 * expected);
    }
}

TEST(ReferenceTracer, ChannelsAreIndependent) {
    const Scene scene = RoomBuilder().room({-1, -1, -1}, {1, 1, 1}, matte({0.2F, 0.5F, 0.8F}, {1, 0.5F, 0.1F})).scene();
    const ReferenceValue value = trace_one(scene, {0.2, -1, 0.3}, {0, 1, 0}, {.samples = 4096});
    EXPECT_NEAR(value.irradiance.x, pi * 1.25, 5 * value.standard_error.x);
    EXPECT_NEAR(value.irradiance.y, pi * 1.0, 5 * value.standard_error.y);
    EXPECT_NEAR(value.irradiance.z, pi * 0.5, 5 * value.standard_error.z);
}

// Howell's catalogue: element opposite the middle of a unit square at distance 1.
TEST(ReferenceTracer, SquareLampAboveAnElement) {
    const Scene scene = RoomBuilder().quad({-0.5F, 1, -0.5F}, {1, 0, 0}, {0, 0, 1}, matte(grey(0), grey(1))).scene();
    const ReferenceValue value = trace_one(scene, {0, 0, 0}, {0, 1, 0}, {.samples = 16384});
    EXPECT_NEAR(value.irradiance.x, pi * 0.239456470461, 5 * value.standard_error.x);
    EXPECT_LT(value.standard_error.x, 1e-3);
}

// Two unit squares that share an edge: F = 0.200043776.
TEST(ReferenceTracer, PerpendicularSquaresExchangeTheirFormFactor) {
    const Scene scene = RoomBuilder()
                            .quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, matte(grey(0), grey(1)))
                            .quad({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, matte(grey(0)))
                            .scene();
    const std::vector<ReferencePoint> points = grid_of_points({0, 0, 0}, 1, 48, {0, 1, 0});
    double mean = 0;
    for (const ReferenceValue& value : trace(scene, points, {.samples = 64}))
        mean += value.irradiance.x / static_cast<double>(points.size());
    // The midpoint rule leaves 1e-4 near the edge, where irradiance jumps to pi / 2.
    EXPECT_NEAR(mean / pi, 0.200043776, 4e-4);
}

TEST(ReferenceTracer, PointLightFollowsTheInverseSquareLaw) {
    const Scene scene = RoomBuilder()
                            .quad({-far, 0, -far}, {0, 0, 2 * far}, {2 * far, 0, 0}, matte(grey(0.5F)))
                            .light(point_light({0, 2, 0}, {4, 8, 12}))
                            .scene();
    const ReferenceValue below = trace_one(scene, {0, 0, 0}, {0, 1, 0});
    EXPECT_NEAR(below.irradiance.x, 1, 1e-6);
    EXPECT_NEAR(below.irradiance.z, 3, 1e-6);
    EXPECT_EQ(below.standard_error.x, 0);
    const double d2 = 9 + 4;
    EXPECT_NEAR(trace_one(scene, {3, 0, 0}, {0, 1, 0}).irradiance.x, 4 * 2 / std::pow(d2, 1.5), 1e-6);
    EXPECT_EQ(trace_one(scene, {0, 3, 0}, {0, 1, 0}).irradiance.x, 0);
}

// Direct light pi everywhere in a unit sphere, of which each bounce returns half: E = 2 pi.
TEST(ReferenceTracer, PointLightIsReflectedAsInAnIntegratingSphere) {
    Mesh sphere;
    constexpr int rows = 48;
    for (int y = 0; y <= rows; ++y)
        for (int x = 0; x <= 2 * rows; ++x) {
            const double polar = pi * y / rows;
            const double around = pi * (x % (2 * rows)) / rows;
            sphere.positions.emplace_back(
                V3d(std::sin(polar) * std::cos(around), std::cos(polar), -std::sin(polar) * std::sin(around)));
        }
    const auto at = [&](int x, int y) { return static_cast<std::uint32_t>(y * (2 * rows + 1) + x); };
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < 2 * rows; ++x)
            for (const std::uint32_t i :
                 {at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y), at(x + 1, y + 1), at(x, y + 1)})
                sphere.indices.push_back(i);
    const auto pi_f = static_cast<float>(pi);
    const Scene scene =
        RoomBuilder().place(sphere, matte(grey(0.5F))).light(point_light({0, 0, 0}, grey(pi_f))).scene();
    double area = 0;
    for (const ReferenceValue& value : trace(scene, points_on(scene, 40, area), {.samples = 1024}))
        EXPECT_NEAR(value.irradiance.x, 2 * pi, 5 * value.standard_error.x + 0.01 * pi);
}

TEST(ReferenceTracer, SpotShinesInsideItsConeOnly) {
    LightSource spot = point_light({0, 2, 0}, grey(4));
    spot.kind = LightKind::spot;
    spot.direction = {0, -1, 0};
    spot.inner_cone_angle = 0.3;
    spot.outer_cone_angle = 0.6;
    const Scene scene =
        RoomBuilder().quad({-far, 0, -far}, {0, 0, 2 * far}, {2 * far, 0, 0}, matte(grey(0))).light(spot).scene();
    const auto at_angle = [&](double angle) {
        return trace_one(scene, {2 * std::tan(angle), 0, 0}, {0, 1, 0}).irradiance.x / std::pow(std::cos(angle), 3);
    };
    EXPECT_NEAR(at_angle(0), 1, 1e-6);
    EXPECT_NEAR(at_angle(0.29), 1, 1e-6);
    const double ramp = (std::cos(0.45) - std::cos(0.6)) / (std::cos(0.3) - std::cos(0.6));
    EXPECT_NEAR(at_angle(0.45), ramp * ramp, 1e-5);
    EXPECT_EQ(at_angle(0.61), 0);
}

TEST(ReferenceTracer, SunIsShadowedAtAnyDistance) {
    const double s = std::sqrt(0.5);
    const Scene scene = RoomBuilder()
                            .quad({-far, 0, -far}, {0, 0, 2 * far}, {2 * far, 0, 0}, matte(grey(0)))
                            .quad({500, 500, -1}, {0, 1, 0}, {0, 0, 2}, matte(grey(0)))
                            .light(sun({-s, -s, 0}, 2))
                            .scene();
    EXPECT_NEAR(trace_one(scene, {5, 0, 0}, {0, 1, 0}).irradiance.x, 2 * s, 1e-6);
    EXPECT_EQ(trace_one(scene, {-0.5, 0, 0}, {0, 1, 0}).irradiance.x, 0);
}

TEST(ReferenceTracer, SkyOverAnOpenFloorIsPiTimesItsRadiance) {
    const Scene scene = RoomBuilder().quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, matte(grey(0.5F))).scene();
    const ReferenceValue value = trace_one(scene, {0, 0, 0}, {0, 1, 0}, {.sky = {1, 2, 3}});
    EXPECT_NEAR(value.irradiance.x, pi, 1e-5);
    EXPECT_NEAR(value.irradiance.z, 3 * pi, 1e-5);
}

TEST(ReferenceTracer, BacksAreBlackAndBlock) {
    const Material lamp = matte(grey(0), grey(1));
    RoomBuilder open;
    open.quad({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}, lamp);
    ASSERT_GT(trace_one(open.scene(), {0, 0, 0}, {0, 1, 0}).irradiance.x, 0.1);
    EXPECT_EQ(trace_one(open.scene(), {0, 3, 0}, {0, -1, 0}).irradiance.x, 0) << "behind the lamp";

    // A sheet between them whose front looks away blocks, and reflects nothing from its back.
    RoomBuilder covered = open;
    covered.quad({-far, 1, -far}, {2 * far, 0, 0}, {0, 0, 2 * far}, matte(grey(0.9F)));
    covered.quad({-far, -1, -far}, {0, 0, 2 * far}, {2 * far, 0, 0}, matte(grey(0.9F)));
    EXPECT_EQ(trace_one(covered.scene(), {0, 0, 0}, {0, 1, 0}).irradiance.x, 0);
}

TEST(ReferenceTracer, DoubleSidedSheetsEmitAndReflectOnBothSides) {
    Material lamp = matte(grey(0), grey(1));
    lamp.double_sided = true;
    const Scene lamp_only = RoomBuilder().quad({-far, 1, -far}, {2 * far, 0, 0}, {0, 0, 2 * far}, lamp).scene();
    for (const double side : {-1.0, 1.0}) {
        const ReferenceValue value = trace_one(lamp_only, {0, 1 - side, 0}, {0, side, 0}, {.samples = 4096});
        EXPECT_NEAR(value.irradiance.x, pi, 5 * value.standard_error.x + 0.01);
    }

    Material paper = matte(grey(0.5F));
    paper.double_sided = true;
    for (const bool front_up : {false, true}) {
        const V3f first = front_up ? V3f(0, 0, 2 * far) : V3f(2 * far, 0, 0);
        const V3f second = front_up ? V3f(2 * far, 0, 0) : V3f(0, 0, 2 * far);
        const Scene scene = RoomBuilder().quad({-far, 0, -far}, first, second, paper).light(sun({0, -1, 0}, 1)).scene();
        const ReferenceValue value = trace_one(scene, {0, 1, 0}, {0, -1, 0}, {.samples = 1024});
        EXPECT_NEAR(value.irradiance.x, 0.5, 5 * value.standard_error.x + 0.001);
    }
}

TEST(ReferenceTracer, DarkSideOfAThinWallIsExactlyDark) {
    const Scene scene = RoomBuilder()
                            .room({0, 0, 0}, {2, 1, 1}, matte(grey(0.9F)))
                            .box({0.999F, 0, 0}, {1.001F, 1, 1}, matte(grey(0.9F)))
                            .quad({0.2F, 1, 0.2F}, {0.4F, 0, 0}, {0, 0, 0.4F}, matte(grey(0), grey(10)))
                            .scene();
    double area = 0;
    std::vector<ReferencePoint> dark = points_on(scene, 400, area);
    std::erase_if(dark, [](const ReferencePoint& point) { return point.position.x < 1.0005; });
    EXPECT_GT(dark.size(), 100U);
    for (const ReferenceValue& value : trace(scene, dark)) EXPECT_EQ(value.irradiance, grey(0));
}

// The wall that parts two cells is two sheets in one place; one emits into its cell, the other belongs to the dark one.
TEST(ReferenceTracer, SheetsBackToBackInOnePlaceKeepTheirSides) {
    const Scene scene = RoomBuilder()
                            .room({0, 0, 0}, {1, 1, 1}, matte(grey(0.5F)))
                            .quad({0.5F, 0, 0}, {0, 1, 0}, {0, 0, 1}, matte(grey(0.5F), grey(1)))
                            .quad({0.5F, 0, 0}, {0, 0, 1}, {0, 1, 0}, matte(grey(0.5F)))
                            .scene();
    EXPECT_EQ(trace_one(scene, {0.25, 0, 0.5}, {0, 1, 0}, {.samples = 4096}).irradiance.x, 0);
    EXPECT_GT(trace_one(scene, {0.75, 0, 0.5}, {0, 1, 0}, {.samples = 4096}).irradiance.x, 1);
}

/// Power that the surface absorbs, with its standard error.
struct Absorbed {
    double power = 0;
    double error = 0;
};

Absorbed absorbed_power(const Scene& scene, std::size_t count, const ReferenceConfig& config,
                        const std::function<bool(const V3d&)>& covered) {
    double area = 0;
    const std::vector<ReferencePoint> points = points_on(scene, count, area);
    const std::vector<ReferenceValue> values = trace(scene, points, config);
    double sum = 0;
    double squares = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (covered(points[i].position)) continue;
        const double absorbed =
            (1 - face_of(scene, points[i].face).material.base_color.r) * values[i].irradiance.x * area;
        sum += absorbed;
        squares += absorbed * absorbed;
    }
    return {sum, std::sqrt(squares)};
}

// Light must not vanish where sheets share a plane: a lamp in the ceiling's plane, a block with its bottom in the
// floor's.
TEST(ReferenceTracer, EmittedPowerIsAbsorbedWithSheetsInOnePlace) {
    const Scene scene = RoomBuilder()
                            .room({-1, 0, -1}, {1, 2, 1}, matte(grey(0.7F)))
                            .box({-0.5F, 0, -0.4F}, {0.1F, 0.9F, 0.3F}, matte(grey(0.7F)))
                            .quad({-0.4F, 2, -0.4F}, {0.8F, 0, 0}, {0, 0, 0.8F}, matte(grey(0), grey(10)))
                            .scene();
    // Ceiling behind the lamp, which is not covered by definition; the lamp itself absorbs what comes back to it.
    const auto behind_lamp = [&](const V3d& p) { return p.y > 1.999 && std::abs(p.x) < 0.4 && std::abs(p.z) < 0.4; };
    const Absorbed absorbed = absorbed_power(scene, 6000, {.samples = 64}, behind_lamp);
    double on_lamp = 0;
    const std::vector<ReferencePoint> lamp = grid_of_points({-0.4, 2, -0.4}, 0.8, 8, {0, -1, 0});
    for (const ReferenceValue& value : trace(scene, lamp))
        on_lamp += value.irradiance.x * 0.64 / static_cast<double>(lamp.size());
    EXPECT_NEAR((absorbed.power + on_lamp) / emitted_power(scene), 1, 0.01);
}

TEST(ReferenceTracer, SizeAndPlaceOfTheSceneDoNotMatter) {
    const auto value_in = [](double scale, const V3d& shift) {
        RoomBuilder builder;
        builder.room({-1, 0, -1}, {1, 2, 1}, matte(grey(0.7F)))
            .box({-0.5F, 0, -0.4F}, {0.1F, 0.9F, 0.3F}, matte(grey(0.7F)))
            .quad({-0.4F, 1.99F, -0.4F}, {0.8F, 0, 0}, {0, 0, 0.8F}, matte(grey(0), grey(10)));
        Imath::M44d matrix;
        matrix.setScale(scale);
        matrix[3][0] = shift.x;
        matrix[3][1] = shift.y;
        matrix[3][2] = shift.z;
        builder.transform(matrix);
        return trace_one(builder.scene(), V3d(0.5, 0, 0.2) * scale + shift, {0, 1, 0}, {.samples = 4096}).irradiance.x;
    };
    const double expected = value_in(1, {0, 0, 0});
    for (const double scale : {1e-6, 1e-3, 1e3, 1e6}) EXPECT_NEAR(value_in(scale, {0, 0, 0}) / expected, 1, 1e-3);
    EXPECT_NEAR(value_in(1, {4.5e6, 10, -5e5}) / expected, 1, 1e-3);
}

TEST(ReferenceTracer, MirroredInstancesKeepTheirFronts) {
    Mesh lamp;
    lamp.positions = {{-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}};
    lamp.indices = {0, 1, 2, 0, 2, 3};
    Imath::M44d mirror;
    mirror[0][0] = -1;
    const Scene plain = RoomBuilder().place(lamp, matte(grey(0), grey(1))).scene();
    const Scene mirrored = RoomBuilder().place(lamp, matte(grey(0), grey(1)), mirror).scene();
    const ReferenceConfig config{.samples = 4096};
    const ReferenceValue expected = trace_one(plain, {0.3, 0, 0}, {0, 1, 0}, config);
    const ReferenceValue found = trace_one(mirrored, {-0.3, 0, 0}, {0, 1, 0}, config);
    EXPECT_GT(expected.irradiance.x, 1);
    EXPECT_NEAR(found.irradiance.x, expected.irradiance.x, 5 * (expected.standard_error.x + found.standard_error.x));
}

TEST(ReferenceTracer, LightPassesWhereAnAlphaMaskCuts) {
    Image image;
    image.width = 2;
    image.height = 1;
    image.rgba = {255, 255, 255, 255, 255, 255, 255, 0};  // left half there, right half cut
    Material leaf = matte(grey(0.5F));
    leaf.alpha_mode = AlphaMode::mask;
    leaf.base_color_texture = TextureView();
    leaf.base_color_texture->nearest = true;
    Mesh sheet;
    sheet.positions = {{-1, 1, -1}, {-1, 1, 1}, {1, 1, 1}, {1, 1, -1}};
    sheet.texcoords = {{{0, 0}, {0, 1}, {1, 1}, {1, 0}}};
    sheet.indices = {0, 1, 2, 0, 2, 3};
    RoomBuilder builder;
    builder.place(sheet, leaf).light(sun({0, -1, 0}, 1));
    Scene scene = builder.scene();
    scene.images.push_back(image);
    EXPECT_EQ(trace_one(scene, {-0.5, 0, 0.1}, {0, 1, 0}).irradiance.x, 0);
    EXPECT_NEAR(trace_one(scene, {0.5, 0, 0.1}, {0, 1, 0}).irradiance.x, 1, 1e-6);
}

TEST(ReferenceTracer, PointsMovedOffTheirFaceByRoundingAreMovedBack) {
    const Scene scene = RoomBuilder().room({-1, -1, -1}, {1, 1, 1}, matte(grey(0), grey(1))).scene();
    double area = 0;
    std::vector<ReferencePoint> points = points_on(scene, 20, area);
    for (ReferencePoint& point : points) point.position -= point.normal * 1e-4;
    for (const ReferenceValue& value : trace(scene, points, {.samples = 64}))
        EXPECT_NEAR(value.irradiance.x, pi, 5 * value.standard_error.x + 1e-5);
    for (ReferencePoint& point : points) point.face = ReferencePoint::no_face;
    for (const ReferenceValue& value : trace(scene, points, {.samples = 64})) EXPECT_EQ(value.irradiance.x, 0);
}

// If standard errors are right, deviations in units of them have a variance of about one (1.15 for 16 replicates).
TEST(ReferenceTracer, StandardErrorsTellTheScatter) {
    const Scene scene = RoomBuilder().room({-1, -1, -1}, {1, 1, 1}, matte(grey(0.5F), grey(0.5F))).scene();
    double area = 0;
    double sum = 0;
    double squares = 0;
    const std::vector<ReferenceValue> values = trace(scene, points_on(scene, 800, area), {.samples = 64});
    for (const ReferenceValue& value : values) {
        const double deviation = (value.irradiance.x - pi) / value.standard_error.x;
        sum += deviation / static_cast<double>(values.size());
        squares += deviation * deviation / static_cast<double>(values.size());
        EXPECT_EQ(value.standard_error.x, value.standard_error.y);
        EXPECT_NEAR(value.mean_standard_error, value.standard_error.x, 1e-3 * value.standard_error.x);
    }
    EXPECT_NEAR(sum, 0, 0.15);
    EXPECT_GT(squares, 0.8);
    EXPECT_LT(squares, 1.6);
}

TEST(ReferenceTracer, SameValuesAtAnyNumberOfThreads) {
    const Scene scene = RoomBuilder()
                            .room({-1, 0, -1}, {1, 2, 1}, matte(grey(0.7F)))
                            .quad({-0.4F, 1.99F, -0.4F}, {0.8F, 0, 0}, {0, 0, 0.8F}, matte(grey(0), grey(10)))
                            .scene();
    double area = 0;
    const std::vector<ReferencePoint> points = points_on(scene, 50, area);
    const std::vector<ReferenceValue> expected = trace(scene, points, {.samples = 64});
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const std::vector<ReferenceValue> found = trace(scene, points, {.samples = 64});
    for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(found[i].irradiance, expected[i].irradiance);
}

TEST(ReferenceTracer, NothingToMeetIsNoError) {
    EXPECT_TRUE(trace({}, {}).empty());
    EXPECT_EQ(trace_one({}, {0, 0, 0}, {0, 0, 1}).irradiance.x, 0);
}

}  // namespace
}  // namespace vmap::reference
