// SPDX-License-Identifier: GPL-3.0-or-later
#include <vmap/error.h>
#include <vmap/importers/sample_surface.h>
#include <vmap/surface_shading.h>

#include "test_scenes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <random>

namespace vmap {
namespace {

using namespace test;
using Imath::C3f;
using Imath::C4f;

SampleConfig count_of(std::size_t points, SamplePattern pattern = SamplePattern::blue_noise) {
    SampleConfig config;
    config.points = points;
    config.pattern = pattern;
    return config;
}

const std::vector<SamplePattern> all_patterns{SamplePattern::blue_noise, SamplePattern::stratified};

double area_of(const PointCloud& cloud) {
    double sum = 0;
    for (const float area : cloud.areas) sum += area;
    return sum;
}

/// Distance to the nearest other point, for every point, over a grid of cells as large as the reach.
std::vector<double> nearest_distances(const PointCloud& cloud, double reach) {
    std::map<std::array<int, 3>, std::vector<std::size_t>> cells;
    const auto cell = [&](const V3f& p) {
        return std::array{static_cast<int>(std::floor(p.x / reach)), static_cast<int>(std::floor(p.y / reach)),
                          static_cast<int>(std::floor(p.z / reach))};
    };
    for (std::size_t i = 0; i < cloud.size(); ++i) cells[cell(cloud.positions[i])].push_back(i);
    std::vector<double> nearest(cloud.size(), reach);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const auto [x, y, z] = cell(cloud.positions[i]);
        for (int dx = -1; dx <= 1; ++dx)
            for (int dy = -1; dy <= 1; ++dy)
                for (int dz = -1; dz <= 1; ++dz) {
                    const auto found = cells.find({x + dx, y + dy, z + dz});
                    if (found == cells.end()) continue;
                    for (const std::size_t j : found->second)
                        if (i != j)
                            nearest[i] =
                                std::min<double>(nearest[i], (cloud.positions[i] - cloud.positions[j]).length());
                }
    }
    return nearest;
}

/// Smallest distance of neighbours over the mean spacing.
double spacing_ratio(const PointCloud& cloud) {
    const double spacing = std::sqrt(area_of(cloud) / static_cast<double>(cloud.size()));
    return std::ranges::min(nearest_distances(cloud, 2 * spacing)) / spacing;
}

std::vector<Scene> varied_scenes() {
    M44d skewed;
    skewed.setScale(V3d(0.5, 2, -3));
    skewed.rotate(V3d(0.3, 1, 2));
    Mesh slivers = grid_mesh(1, 1, 1, 3000);
    std::vector<Scene> scenes{scene_of(grid_mesh(3, 2, 1, 1)),       scene_of(grid_mesh(3, 2, 57, 43)),
                              scene_of(box_mesh({1, 2, 3})),         scene_of(box_mesh({1, 2, 3}), {}, skewed),
                              scene_of(sphere_mesh(64, 32)),         scene_of(sphere_mesh(7, 5)),
                              scene_of(grid_mesh(1000, 0.1F, 1, 1)), scene_of(slivers)};
    Scene two = scene_of(box_mesh({1, 1, 1}));
    two.meshes.push_back(grid_mesh(0.05F, 0.05F, 1, 1));
    two.meshes[1].material = 1;
    two.materials.push_back(Material{});
    two.instances.push_back({.name = "two", .mesh = 1, .world_from_mesh = M44d()});
    scenes.push_back(two);
    return scenes;
}

TEST(SampleSurface, MakesAsManyPointsAsAskedFor) {
    for (const SamplePattern pattern : all_patterns)
        for (const Scene& scene : varied_scenes())
            for (const std::size_t points : {2U, 3U, 17U, 1000U, 30011U}) {
                const PointCloud cloud = sample_surface(scene, count_of(points, pattern));
                EXPECT_EQ(cloud.size(), points);
            }
}

TEST(SampleSurface, AreasSumToTheSurfaceOfEachMaterial) {
    for (const SamplePattern pattern : all_patterns)
        for (const Scene& scene : varied_scenes())
            for (const std::size_t points : {3U, 100U, 20000U}) {
                const PointCloud cloud = sample_surface(scene, count_of(points, pattern));
                std::vector<double> found(scene.materials.size(), 0);
                for (std::size_t i = 0; i < cloud.size(); ++i) found[cloud.materials[i]] += cloud.areas[i];
                std::vector<double> expected(scene.materials.size(), 0);
                for (std::size_t i = 0; i < scene.instances.size(); ++i) {
                    const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
                    for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
                        expected[mesh.material] += world_area_normal(scene, i, t).length() / 2;
                }
                for (std::size_t m = 0; m < expected.size(); ++m)
                    EXPECT_NEAR(found[m] / expected[m], 1, 1e-5) << points << " points, material " << m;
            }
}

TEST(SampleSurface, PointsLieOnTheFacesTheyName) {
    for (const SamplePattern pattern : all_patterns)
        for (const Scene& scene : varied_scenes()) {
            const PointCloud cloud = sample_surface(scene, count_of(5000, pattern));
            const std::vector<std::size_t> first = first_faces(scene);
            for (std::size_t i = 0; i < cloud.size(); ++i) {
                std::size_t instance = 0;
                while (first[instance + 1] <= cloud.faces[i]) ++instance;
                const auto [a, b, c] = world_triangle(scene, instance, cloud.faces[i] - first[instance]);
                const V3d p = V3d(cloud.positions[i]) + cloud.origin;
                const double whole = (b - a).cross(c - a).length();
                const double parts =
                    (a - p).cross(b - p).length() + (b - p).cross(c - p).length() + (c - p).cross(a - p).length();
                const double edge = std::max({(b - a).length(), (c - b).length(), (a - c).length()});
                ASSERT_NEAR(parts, whole, 1e-5 * edge * edge);
                const V3d normal = world_area_normal(scene, instance, cloud.faces[i] - first[instance]).normalized();
                ASSERT_NEAR((V3d(cloud.normals[i]) - normal).length(), 0, 1e-6);
                ASSERT_EQ(cloud.materials[i], scene.meshes[scene.instances[instance].mesh].material);
            }
        }
}

TEST(BlueNoise, NeighboursOfAFlatGroupKeepTheirDistance) {
    for (const auto& [columns, rows] : {std::pair(1, 1), {10, 10}, {1, 40}, {300, 200}})
        for (const std::size_t points : {50U, 1000U, 40000U}) {
            const PointCloud cloud = sample_surface(scene_of(grid_mesh(3, 2, columns, rows)), count_of(points));
            EXPECT_GE(spacing_ratio(cloud), 0.6) << columns << " x " << rows << " quads, " << points << " points";
        }
}

/// Number of the flat part of every face: faces that share an edge and a plane.
std::vector<std::size_t> flat_parts(const Scene& scene) {
    const std::vector<std::size_t> first = first_faces(scene);
    std::vector<std::size_t> parent(first.back());
    std::iota(parent.begin(), parent.end(), std::size_t{0});
    const auto root = [&](std::size_t face) {
        while (parent[face] != face) face = parent[face];
        return face;
    };
    std::map<std::array<double, 6>, std::pair<std::size_t, V3d>> seen;  // face and normal on an edge
    for (std::size_t i = 0; i < scene.instances.size(); ++i)
        for (std::size_t face = first[i]; face < first[i + 1]; ++face) {
            const auto corners = world_triangle(scene, i, face - first[i]);
            const V3d normal = world_area_normal(scene, i, face - first[i]).normalized();
            for (int k = 0; k < 3; ++k) {
                std::array<double, 3> a{corners[k].x, corners[k].y, corners[k].z};
                std::array<double, 3> b{corners[(k + 1) % 3].x, corners[(k + 1) % 3].y, corners[(k + 1) % 3].z};
                if (b < a) std::swap(a, b);
                const auto [found, is_new] =
                    seen.try_emplace({a[0], a[1], a[2], b[0], b[1], b[2]}, std::pair(face, normal));
                if (!is_new && found->second.second.dot(normal) > 0.99999)
                    parent[root(face)] = root(found->second.first);
            }
        }
    for (std::size_t face = 0; face < parent.size(); ++face) parent[face] = root(face);
    return parent;
}

/// Smallest distance of two points of one flat part over the mean spacing; points are few.
double flat_spacing_ratio(const Scene& scene, const PointCloud& cloud) {
    const std::vector<std::size_t> part_of = flat_parts(scene);
    std::map<std::size_t, std::vector<std::size_t>> parts;
    for (std::size_t i = 0; i < cloud.size(); ++i) parts[part_of[cloud.faces[i]]].push_back(i);
    const double spacing = std::sqrt(area_of(cloud) / static_cast<double>(cloud.size()));
    double nearest = std::numeric_limits<double>::max();
    for (const auto& [part, points] : parts)
        for (const std::size_t i : points)
            for (const std::size_t j : points)
                if (i < j) nearest = std::min<double>(nearest, (cloud.positions[i] - cloud.positions[j]).length());
    return nearest / spacing;
}

TEST(BlueNoise, NeighboursOfEveryFlatPartKeepTheirDistance) {
    std::vector<Scene> scenes = varied_scenes();
    scenes.push_back(scene_of(sphere_mesh(16, 9)));
    scenes.push_back(scene_of(box_mesh({0.02F, 5, 1})));
    for (std::size_t s = 0; s < scenes.size(); ++s)
        for (const std::size_t points : {17U, 100U, 400U, 3000U})
            EXPECT_GE(flat_spacing_ratio(scenes[s], sample_surface(scenes[s], count_of(points))), 0.6)
                << "scene " << s << ", " << points << " points";
}

TEST(BlueNoise, NeighboursKeepTheirDistanceInAStrip) {
    EXPECT_GE(spacing_ratio(sample_surface(scene_of(grid_mesh(100, 1, 50, 1)), count_of(10000))), 0.6);
    EXPECT_GE(spacing_ratio(sample_surface(scene_of(grid_mesh(1, 100, 1, 1)), count_of(1000))), 0.6);
}

TEST(BlueNoise, IsEvenOnCurvedSurface) {
    const PointCloud cloud = sample_surface(scene_of(sphere_mesh(256, 128)), count_of(20000));
    const double spacing = std::sqrt(4 * std::numbers::pi / 20000);
    std::vector<double> nearest = nearest_distances(cloud, 2 * spacing);
    std::ranges::sort(nearest);
    EXPECT_GE(nearest[0] / spacing, 0.6);
    EXPECT_GE(nearest[nearest.size() / 2] / spacing, 0.75);
    // The number of points in each of the eight octants: random points differ by 2 %.
    std::array<int, 8> octants{};
    for (const V3f& p : cloud.positions) ++octants[(p.x > 0 ? 1 : 0) + (p.y > 0 ? 2 : 0) + (p.z > 0 ? 4 : 0)];
    for (const int count : octants) EXPECT_NEAR(count, 2500, 25);
}

// Where points keep away from the edges or crowd there, the outlines and areas that are derived from them are wrong.
TEST(BlueNoise, DensityIsEvenUpToTheBorders) {
    constexpr std::size_t count = 40000;
    for (const SamplePattern pattern : all_patterns) {
        std::array<double, 8> bands{};
        for (std::uint64_t seed = 1; seed <= 5; ++seed) {
            SampleConfig config = count_of(count, pattern);
            config.seed = seed;
            const PointCloud cloud = sample_surface(scene_of(grid_mesh(1, 1, 1, 1)), config);
            const double spacing = 1 / std::sqrt(count);
            for (const V3f& p : cloud.positions) {
                const double depth = std::min({p.x, 1 - p.x, p.y, 1 - p.y}) / (spacing / 4);
                if (depth < 8) bands[static_cast<int>(depth)] += 1;
            }
        }
        const double per_band = 5 * 4 * std::sqrt(count) / 4;
        for (const double band : bands) EXPECT_NEAR(band / per_band, 1, 0.08);
    }
}

TEST(SampleSurface, SameBytesAtAnyNumberOfThreads) {
    Scene scene = scene_of(sphere_mesh(50, 30));
    scene.meshes.push_back(grid_mesh(10, 10, 1, 1));
    scene.instances.push_back({.name = "floor", .mesh = 1, .world_from_mesh = M44d()});
    for (const SamplePattern pattern : all_patterns) {
        std::vector<PointCloud> clouds;
        for (const int threads : {1, 2, 3, 8}) {
            const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
            clouds.push_back(sample_surface(scene, count_of(60000, pattern)));
        }
        for (const PointCloud& cloud : clouds) EXPECT_TRUE(cloud == clouds[0]);
    }
}

TEST(SampleSurface, SeedChangesThePoints) {
    SampleConfig other = count_of(100);
    other.seed = 2;
    const Scene scene = scene_of(grid_mesh(1, 1, 1, 1));
    EXPECT_NE(sample_surface(scene, count_of(100)).positions, sample_surface(scene, other).positions);
}

TEST(SampleSurface, SpacingGivesAreaPerPoint) {
    SampleConfig config;
    config.spacing = 0.1;
    SampleReport report;
    const PointCloud cloud = sample_surface(scene_of(grid_mesh(3, 2, 1, 1)), config, {}, &report);
    EXPECT_EQ(cloud.size(), 600U);
    EXPECT_NEAR(report.spacing, 0.1, 1e-9);
    EXPECT_NEAR(report.area, 6, 1e-9);
}

TEST(SampleSurface, MirroredInstanceKeepsOutwardNormals) {
    M44d mirror;
    mirror.setScale(V3d(-1, 1, 1));
    const PointCloud cloud = sample_surface(scene_of(box_mesh({1, 1, 1}), {}, mirror), count_of(2000));
    const V3d center(-0.5, 0.5, 0.5);
    for (std::size_t i = 0; i < cloud.size(); ++i)
        ASSERT_GT(V3d(cloud.normals[i]).dot(V3d(cloud.positions[i]) - center), 0);
}

TEST(SampleSurface, ShadingNormalsOnRequest) {
    SampleConfig config = count_of(1000);
    config.normals = SampleNormals::shading;
    const PointCloud cloud = sample_surface(scene_of(sphere_mesh(12, 8)), config);
    for (std::size_t i = 0; i < cloud.size(); ++i)
        ASSERT_NEAR((cloud.normals[i] - cloud.positions[i].normalized()).length(), 0, 2e-2);
}

Material double_sided() {
    Material material;
    material.double_sided = true;
    return material;
}

TEST(Sides, OpenDoubleSidedSheetHasPointsOnBothSides) {
    const PointCloud cloud = sample_surface(scene_of(grid_mesh(1, 1, 1, 1), double_sided()), count_of(2000));
    const auto front = std::ranges::count_if(cloud.normals, [](const V3f& n) { return n.z > 0; });
    EXPECT_EQ(front, 1000);
    EXPECT_NEAR(area_of(cloud), 2, 1e-5);
}

TEST(Sides, InsideOfAClosedPartIsLeftOut) {
    const PointCloud cloud = sample_surface(scene_of(box_mesh({1, 1, 1}), double_sided()), count_of(2000));
    EXPECT_NEAR(area_of(cloud), 6, 1e-5);
    for (std::size_t i = 0; i < cloud.size(); ++i)
        ASSERT_GT(V3d(cloud.normals[i]).dot(V3d(cloud.positions[i]) - V3d(0.5)), 0);
}

TEST(Sides, InsideOfAnInsideOutPartIsItsFront) {
    Mesh box = box_mesh({1, 1, 1});
    for (std::size_t i = 0; i < box.indices.size(); i += 3) std::swap(box.indices[i], box.indices[i + 1]);
    const PointCloud cloud = sample_surface(scene_of(box, double_sided()), count_of(2000));
    EXPECT_NEAR(area_of(cloud), 6, 1e-5);
    for (std::size_t i = 0; i < cloud.size(); ++i)
        ASSERT_GT(V3d(cloud.normals[i]).dot(V3d(cloud.positions[i]) - V3d(0.5)), 0);
}

TEST(Sides, InsideStaysWhereALightACameraOrALampIs) {
    Scene with_light = scene_of(box_mesh({1, 1, 1}), double_sided());
    with_light.lights.push_back({.kind = LightKind::point, .name = "bulb", .position = V3d(0.5)});
    EXPECT_NEAR(area_of(sample_surface(with_light, count_of(1000))), 12, 1e-4);
    with_light.lights[0].position = V3d(2);
    EXPECT_NEAR(area_of(sample_surface(with_light, count_of(1000))), 6, 1e-4);
    with_light.lights[0] = {.kind = LightKind::sun, .name = "sun", .position = V3d(0.5)};
    EXPECT_NEAR(area_of(sample_surface(with_light, count_of(1000))), 6, 1e-4);

    Scene with_camera = scene_of(box_mesh({1, 1, 1}), double_sided());
    M44d inside;
    inside.setTranslation(V3d(0.3));
    with_camera.cameras.push_back({.name = "eye", .world_from_camera = inside});
    EXPECT_NEAR(area_of(sample_surface(with_camera, count_of(1000))), 12, 1e-4);

    Scene with_lamp = scene_of(box_mesh({1, 1, 1}), double_sided());
    with_lamp.meshes.push_back(box_mesh(V3f(0.1F)));
    with_lamp.meshes[1].material = 1;
    with_lamp.materials.push_back(double_sided());
    with_lamp.materials[1].emission = C3f(1);
    with_lamp.instances.push_back({.name = "lamp", .mesh = 1, .world_from_mesh = inside});
    EXPECT_NEAR(area_of(sample_surface(with_lamp, count_of(1000))), 12 + 0.06, 1e-4);
}

TEST(Sides, OnRequestFrontOrBoth) {
    SampleConfig config = count_of(1000);
    config.sides = SampleSides::front;
    EXPECT_NEAR(area_of(sample_surface(scene_of(grid_mesh(1, 1, 1, 1), double_sided()), config)), 1, 1e-5);
    config.sides = SampleSides::both;
    EXPECT_NEAR(area_of(sample_surface(scene_of(grid_mesh(1, 1, 1, 1)), config)), 2, 1e-5);
}

Image checkerboard(int size) {
    Image image{.name = "checks", .width = size, .height = size, .rgba = {}};
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            image.rgba.insert(image.rgba.end(), 4, static_cast<std::uint8_t>((x + y) % 2 == 0 ? 255 : 0));
    return image;
}

TEST(Texture, FinerThanTheSpacingIsAveraged) {
    Scene scene = scene_of(grid_mesh(1, 1, 1, 1));
    scene.images = {checkerboard(512)};
    scene.materials[0].base_color_texture = TextureView{};
    const PointCloud cloud = sample_surface(scene, count_of(1000));
    for (const C3f& albedo : cloud.albedo) ASSERT_NEAR(albedo.x, 0.5, 0.03);
}

TEST(Texture, CoarserThanTheSpacingIsKept) {
    Scene scene = scene_of(grid_mesh(1, 1, 1, 1));
    scene.images = {checkerboard(4)};
    scene.materials[0].base_color_texture = TextureView{.nearest = true};
    const PointCloud cloud = sample_surface(scene, count_of(20000));
    const auto mixed = std::ranges::count_if(cloud.albedo, [](const C3f& a) { return a.x > 0.01 && a.x < 0.99; });
    EXPECT_LT(mixed, 2000);
    double mean = 0;
    for (const C3f& albedo : cloud.albedo) mean += albedo.x / 20000;
    EXPECT_NEAR(mean, 0.5, 5e-3);
}

TEST(Emission, PowerOfATexturedLampIsKept) {
    Scene scene = scene_of(grid_mesh(1, 1, 1, 1));
    scene.images = {checkerboard(64)};
    scene.materials[0].emission = C3f(8, 4, 0);
    scene.materials[0].emission_texture = TextureView{};
    for (const std::size_t points : {100U, 10000U}) {
        const PointCloud cloud = sample_surface(scene, count_of(points));
        ASSERT_TRUE(cloud.emits());
        C3f power(0);
        for (std::size_t i = 0; i < cloud.size(); ++i) power += cloud.emission[i] * cloud.areas[i];
        EXPECT_NEAR(power.x, 4, 0.05);
        EXPECT_NEAR(power.y, 2, 0.025);
        EXPECT_EQ(power.z, 0);
    }
}

TEST(Emission, SmallLampOfItsOwnMaterialAlwaysHasAPoint) {
    Scene scene = scene_of(grid_mesh(100, 100, 1, 1));
    scene.meshes.push_back(grid_mesh(0.001F, 0.001F, 1, 1));
    scene.meshes[1].material = 1;
    scene.materials.push_back(Material{});
    scene.materials[1].emission = C3f(1);
    scene.instances.push_back({.name = "lamp", .mesh = 1, .world_from_mesh = M44d()});
    const PointCloud cloud = sample_surface(scene, count_of(100));
    EXPECT_EQ(cloud.size(), 100U);
    double power = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) power += cloud.emission[i].x * cloud.areas[i];
    EXPECT_NEAR(power / 1e-6, 1, 1e-5);
}

TEST(AlphaMask, CutsPointsAndArea) {
    // The image's left half can be seen through.
    Scene scene = scene_of(grid_mesh(2, 1, 1, 1));
    scene.images = {{.name = "half", .width = 2, .height = 1, .rgba = {255, 255, 255, 0, 255, 255, 255, 255}}};
    scene.materials[0].base_color_texture = TextureView{.nearest = true};
    scene.materials[0].alpha_mode = AlphaMode::mask;
    for (const SamplePattern pattern : all_patterns) {
        const PointCloud cloud = sample_surface(scene, count_of(3000, pattern));
        EXPECT_EQ(cloud.size(), 3000U);
        EXPECT_NEAR(area_of(cloud), 1, 2e-3);
        for (const V3f& p : cloud.positions) ASSERT_GE(p.x, 1 - 1e-6);
    }
}

TEST(AlphaMask, NothingLeftIsRefused) {
    Scene scene = scene_of(grid_mesh(1, 1, 1, 1));
    scene.materials[0].alpha_mode = AlphaMode::mask;
    scene.materials[0].base_color.a = 0;
    EXPECT_THROW((void)sample_surface(scene, count_of(10)), UnsupportedInput);
}

TEST(SampleSurface, DegenerateTrianglesAreLeftOutWithAWarning) {
    Mesh mesh = grid_mesh(1, 1, 1, 1);
    mesh.positions.emplace_back(2.0F, 0.0F, 0.0F);
    for (const std::uint32_t i : {0U, 0U, 1U, 0U, 1U, 4U}) mesh.indices.push_back(i);
    SampleReport report;
    const PointCloud cloud = sample_surface(scene_of(mesh), count_of(100), {}, &report);
    EXPECT_EQ(report.degenerate_faces, 2U);
    EXPECT_THAT(report.warnings, testing::ElementsAre(testing::HasSubstr("2 triangles have no area")));
    EXPECT_NEAR(area_of(cloud), 1, 1e-5);
}

TEST(SampleSurface, AlbedoAboveOneIsClampedWithAWarning) {
    Scene scene = scene_of(grid_mesh(1, 1, 1, 1));
    scene.materials[0].base_color = C4f(2, 0.5F, 1, 1);
    SampleReport report;
    const PointCloud cloud = sample_surface(scene, count_of(10), {}, &report);
    EXPECT_EQ(cloud.albedo[0], C3f(1, 0.5F, 1));
    EXPECT_THAT(report.warnings, testing::ElementsAre(testing::HasSubstr("10 points")));
}

TEST(SampleSurface, RefusesWhatCannotBeSampled) {
    const Scene scene = scene_of(grid_mesh(1, 1, 1, 1));
    EXPECT_THROW((void)sample_surface(Scene{}), UnsupportedInput);
    EXPECT_THROW((void)sample_surface(scene_of(Mesh{})), UnsupportedInput);
    EXPECT_THROW((void)sample_surface(scene, count_of(0)), UsageError);
    SampleConfig config;
    for (const double spacing : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), 1e-9}) {
        config.spacing = spacing;
        EXPECT_THROW((void)sample_surface(scene, config), UsageError) << spacing;
    }
    config = count_of(10);
    config.spacing = 1;
    EXPECT_THROW((void)sample_surface(scene, config), UsageError);
}

TEST(SampleSurface, KeepsMillimetresFarFromTheOrigin) {
    M44d far_away;
    far_away.setTranslation(V3d(4.5e6, 0, -3.2e6));
    const Scene scene = scene_of(grid_mesh(0.1F, 0.1F, 3, 3), {}, far_away);
    const PointCloud cloud = sample_surface(scene, count_of(10000));
    EXPECT_GE(spacing_ratio(cloud), 0.6);
    for (const V3f& p : cloud.positions) {
        const V3d world = V3d(p) + cloud.origin;
        ASSERT_GE(world.x, 4.5e6 - 1e-4);
        ASSERT_LE(world.x, 4.5e6 + 0.1 + 1e-4);
    }
    EXPECT_EQ(sample_surface(scene_of(grid_mesh(1, 1, 1, 1)), count_of(10000)).origin, V3d(0));
}

TEST(SampleSurface, ExceptionOfTheCallbackStopsTheWork) {
    const ProgressCallback stop = [](std::string_view, double) { throw Error(ExitCode::interrupted, "stop"); };
    EXPECT_THROW((void)sample_surface(scene_of(grid_mesh(1, 1, 1, 1)), count_of(100), stop), Error);
}

TEST(SampleSurface, ProgressRisesToOne) {
    for (const Scene& scene : varied_scenes()) {
        double last = 0;
        const ProgressCallback check = [&](std::string_view stage, double fraction) {
            EXPECT_EQ(stage, "sample");
            EXPECT_GE(fraction, last);
            last = fraction;
        };
        (void)sample_surface(scene, count_of(20000), check);
        EXPECT_EQ(last, 1);
    }
}

TEST(SampleSurface, WorkStopsInTheMiddle) {
    int calls = 0;
    const ProgressCallback stop = [&](std::string_view, double fraction) {
        ++calls;
        if (fraction > 0.5) throw Error(ExitCode::interrupted, "stop");
    };
    EXPECT_THROW((void)sample_surface(scene_of(sphere_mesh(100, 50)), count_of(50000), stop), Error);
    EXPECT_GT(calls, 3);
}

TEST(SampleSurface, SizesThatFloatsCannotHoldAreRefused) {
    for (const double size : {1e-25, 1e25}) {
        M44d scale;
        scale.setScale(V3d(size));
        EXPECT_THROW((void)sample_surface(scene_of(box_mesh({1, 1, 1}), {}, scale), count_of(100)), UnsupportedInput);
    }
}

TEST(SampleSurface, WorksAtAnyOrdinaryScale) {
    for (const double size : {1e-9, 1e-3, 1e3, 1e9}) {
        M44d scale;
        scale.setScale(V3d(size));
        const PointCloud cloud = sample_surface(scene_of(sphere_mesh(40, 20), {}, scale), count_of(2000));
        EXPECT_GE(spacing_ratio(cloud), 0.5) << size;  // across edges too
    }
}

TEST(SampleSurface, SharedMeshesAreNumberedPerInstance) {
    Scene scene = scene_of(grid_mesh(1, 1, 1, 1));
    M44d moved;
    moved.setTranslation(V3d(5, 0, 0));
    scene.instances.push_back({.name = "two", .mesh = 0, .world_from_mesh = moved});
    const PointCloud cloud = sample_surface(scene, count_of(400));
    for (std::size_t i = 0; i < cloud.size(); ++i) ASSERT_EQ(cloud.faces[i] >= 2, cloud.positions[i].x > 4);
    EXPECT_EQ(*std::ranges::max_element(cloud.faces), 3U);
}

}  // namespace
}  // namespace vmap
