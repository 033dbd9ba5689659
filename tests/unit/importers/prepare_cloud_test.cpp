// SPDX-License-Identifier: GPL-3.0-or-later
// Raw clouds made from surfaces whose normals and areas are known: what is estimated is compared with those.
#include <vmap/error.h>
#include <vmap/importers/input.h>
#include <vmap/importers/prepare_cloud.h>
#include <vmap/importers/sample_surface.h>
#include <vmap/light.h>

#include "cloud/neighbours.h"
#include "test_scenes.h"

#include <Imath/ImathBox.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>

namespace vmap {
namespace {

using namespace test;
namespace fs = std::filesystem;

double area_of(const PointCloud& cloud) {
    return std::accumulate(cloud.areas.begin(), cloud.areas.end(), 0.0);
}

PointCloud sampled(const Scene& scene, std::size_t points) {
    SampleConfig config;
    config.points = points;
    config.sides = SampleSides::front;
    return sample_surface(scene, config);
}

/// The places alone, moved about by a normal distribution; `faces` says which point each one is.
LitCloud scan_of(const PointCloud& cloud, double noise_in_spacings = 0) {
    LitCloud scan;
    scan.points.origin = cloud.origin;
    scan.points.positions = cloud.positions;
    scan.points.faces.resize(cloud.size());
    std::iota(scan.points.faces.begin(), scan.points.faces.end(), 0U);
    const double spacing = std::sqrt(area_of(cloud) / static_cast<double>(cloud.size()));
    std::mt19937_64 random(1);
    std::normal_distribution<double> distribution(0, noise_in_spacings * spacing + 1e-300);
    for (V3f& position : scan.points.positions)
        position += V3f(V3d(distribution(random), distribution(random), distribution(random)));
    return scan;
}

struct NormalFigures {
    double within_10_degrees = 0;  ///< share of the points, whatever the side
    double flipped = 0;            ///< share of the points that face the other side
};

NormalFigures compare_normals(const PointCloud& estimated, const PointCloud& truth) {
    NormalFigures figures;
    for (std::size_t i = 0; i < estimated.size(); ++i) {
        const double cosine = estimated.normals[i].dot(truth.normals[estimated.faces[i]]);
        figures.within_10_degrees += std::abs(cosine) > std::cos(10 * std::numbers::pi / 180) ? 1 : 0;
        figures.flipped += cosine < 0 ? 1 : 0;
    }
    figures.within_10_degrees /= static_cast<double>(estimated.size());
    figures.flipped /= static_cast<double>(estimated.size());
    return figures;
}

LightSource point_light(const V3d& position) {
    LightSource light;
    light.position = position;
    light.intensity = {1, 1, 1};
    return light;
}

struct LightDifference {
    double mean = 0;      ///< area-weighted mean difference over the mean of the true light
    double left_out = 0;  ///< share of the points at the borders of shadows
};

/// Light on a prepared scan against that on the true points. Points are left out where the true light on some of the
/// six nearest points is less than half of that on others: at borders of shadows it changes over one spacing.
LightDifference compare_light(const PointCloud& scan, const PointCloud& truth, std::span<const LightSource> lights) {
    const std::vector<Imath::C3f> expected = compute_light(truth, lights).irradiance;
    const std::vector<Imath::C3f> found = compute_light(scan, lights).irradiance;
    const Neighbours neighbours = find_neighbours(truth.positions, 6);
    LightDifference result;
    double difference = 0;
    double sum = 0;
    for (std::size_t i = 0; i < scan.size(); ++i) {
        const std::uint32_t j = scan.faces[i];
        float least = expected[j].x;
        float most = least;
        for (const std::uint32_t k : neighbours.of(j)) {
            least = std::min(least, expected[k].x);
            most = std::max(most, expected[k].x);
        }
        if (least < most / 2) {
            result.left_out += 1.0 / static_cast<double>(scan.size());
            continue;
        }
        difference += static_cast<double>(std::abs(found[i].x - expected[j].x) * truth.areas[j]);
        sum += static_cast<double>(expected[j].x * truth.areas[j]);
    }
    result.mean = difference / sum;
    return result;
}

PointCloud cornell_points(std::size_t count) {
    PointCloud cloud = sampled(read_input(fs::path(VMAP_SCENES) / "cornell_box.gltf").scene, count);
    cloud.emission.clear();
    cloud.albedo.assign(cloud.size(), {0.6F, 0.6F, 0.6F});
    return cloud;
}

V3d middle_of(const PointCloud& cloud) {
    Imath::Box3d box;
    for (const V3f& position : cloud.positions) box.extendBy(V3d(position));
    return box.center();
}

class ScannedRoom : public testing::TestWithParam<double> {};

TEST_P(ScannedRoom, HasTheNormalsAndTheAreaOfTheCleanOne) {
    const PointCloud truth = cornell_points(60'000);
    LitCloud scan = scan_of(truth, GetParam());
    PrepareReport report;
    prepare_cloud(scan, {}, &report);
    const NormalFigures figures = compare_normals(scan.points, truth);
    EXPECT_GE(figures.within_10_degrees, 0.98);
    EXPECT_LE(figures.flipped, 0.005);
    EXPECT_NEAR(report.area / area_of(truth), 1, 0.02);
    EXPECT_LE(report.outliers, 10U);
}
INSTANTIATE_TEST_SUITE_P(Noise, ScannedRoom, testing::Values(0.0, 0.1));

TEST(ScannedRoom, IsLitLikeTheCleanOne) {
    const PointCloud truth = cornell_points(60'000);
    LitCloud scan = scan_of(truth, 0.1);
    scan.points.albedo = truth.albedo;
    const LightSource light = point_light(middle_of(truth) + V3d(0, 1, 0.5));
    prepare_cloud(scan, {.lights = {&light, 1}});
    const LightDifference difference = compare_light(scan.points, truth, {&light, 1});
    EXPECT_LT(difference.mean, 0.05);
    EXPECT_LT(difference.left_out, 0.1);
}

TEST(ScannedRoom, WithoutFurnitureFacesTheLightInIt) {
    const PointCloud truth = sampled(read_input(fs::path(VMAP_SCENES) / "cornell_empty.gltf").scene, 20'000);
    LitCloud scan = scan_of(truth);
    const LightSource light = point_light(middle_of(truth));
    PrepareReport report;
    prepare_cloud(scan, {.lights = {&light, 1}}, &report);
    EXPECT_LE(compare_normals(scan.points, truth).flipped, 0.005);
    EXPECT_THAT(report.warnings, testing::Contains(testing::HasSubstr("surround a light")));
}

class ScannedStatue : public testing::Test {
protected:
    /// The vertices of the mesh with the mean normals and a third of the areas of the triangles around them.
    static PointCloud statue() {
        const fs::path file = fs::path(VMAP_SHARED) / "models" / "igea.ply";
        if (!fs::exists(file)) return {};
        const Scene scene = read_input(file).scene;
        PointCloud cloud;
        const Mesh& mesh = scene.meshes.front();
        std::vector<V3d> sums(mesh.positions.size(), V3d(0));
        cloud.areas.resize(mesh.positions.size());
        for (const V3f& p : mesh.positions) cloud.positions.emplace_back(V3d(p) * scene.instances[0].world_from_mesh);
        for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
            const std::uint32_t* v = mesh.indices.data() + 3 * t;
            const V3d a(cloud.positions[v[0]]);
            const V3d normal = (V3d(cloud.positions[v[1]]) - a).cross(V3d(cloud.positions[v[2]]) - a);
            for (int k = 0; k < 3; ++k) {
                sums[v[k]] += normal;
                cloud.areas[v[k]] += static_cast<float>(normal.length() / 6);
            }
        }
        for (const V3d& sum : sums) cloud.normals.emplace_back(sum.normalized());
        cloud.albedo.assign(cloud.size(), {0.6F, 0.6F, 0.6F});
        return cloud;
    }
};

TEST_F(ScannedStatue, HasTheNormalsTheAreaAndTheLightOfTheMesh) {
    const PointCloud truth = statue();
    if (truth.empty()) GTEST_SKIP() << "igea.ply is not beside the repository";
    LitCloud scan = scan_of(truth);
    scan.points.albedo = truth.albedo;
    PrepareReport report;
    prepare_cloud(scan, {}, &report);
    const NormalFigures figures = compare_normals(scan.points, truth);
    EXPECT_GE(figures.within_10_degrees, 0.98);
    EXPECT_LE(figures.flipped, 0.005);
    EXPECT_NEAR(report.area / area_of(truth), 1, 0.02);
    std::vector<LightSource> lights;
    for (const V3d& place : {V3d(0.5, 1, 2), V3d(-2, 0.5, 1), V3d(2, 0, -0.5), V3d(0, 0.5, -2)})
        lights.push_back(point_light(middle_of(truth) + place));
    const LightDifference difference = compare_light(scan.points, truth, lights);
    EXPECT_LT(difference.mean, 0.05);
    EXPECT_LT(difference.left_out, 0.25);
}

LitCloud scanned_sphere(std::size_t points = 4000) {
    return scan_of(sampled(scene_of(sphere_mesh(64, 32)), points));
}

/// Share of the points of a sphere about the origin that face away from it.
double outward_share(const PointCloud& cloud) {
    double count = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) count += cloud.normals[i].dot(cloud.positions[i]) > 0 ? 1 : 0;
    return count / static_cast<double>(cloud.size());
}

double outward_share_with(const PrepareConfig& config) {
    LitCloud scan = scanned_sphere();
    prepare_cloud(scan, config);
    return outward_share(scan.points);
}

TEST(PrepareCloud, TurnsASphereToTheSideAskedFor) {
    EXPECT_EQ(outward_share_with({}), 1);
    EXPECT_EQ(outward_share_with({.side = CloudSide::outward}), 1);
    EXPECT_EQ(outward_share_with({.side = CloudSide::topmost}), 1);
    EXPECT_EQ(outward_share_with({.side = CloudSide::inward}), 0);
    EXPECT_EQ(outward_share_with({.viewpoint = V3d(0, 0, 0)}), 0);
}

TEST(PrepareCloud, SeesOnlyHalfASphereFromOutside) {
    EXPECT_NEAR(outward_share_with({.viewpoint = V3d(0, 0, 1000)}), 0.5, 0.02);
}

TEST(PrepareCloud, FacesALightInsideButNotOneOutside) {
    const LightSource inside = point_light({0.3, 0.2, 0});
    const LightSource outside = point_light({0, 3, 0});
    EXPECT_EQ(outward_share_with({.lights = {&inside, 1}}), 0);
    EXPECT_EQ(outward_share_with({.lights = {&outside, 1}}), 1);
}

TEST(PrepareCloud, GoesAroundTheCreasesOfABoxAndAThinWall) {
    for (const V3f& size : {V3f(1, 2, 3), V3f(2, 2, 0.1F)}) {
        const PointCloud truth = sampled(scene_of(box_mesh(size)), 30'000);
        LitCloud scan = scan_of(truth);
        prepare_cloud(scan);
        const NormalFigures figures = compare_normals(scan.points, truth);
        EXPECT_LE(figures.flipped, 0.002) << size;
        EXPECT_GE(figures.within_10_degrees, 0.98) << size;
        EXPECT_NEAR(area_of(scan.points) / area_of(truth), 1, 0.02) << size;
    }
}

TEST(PrepareCloud, EndsAnOpenSheetNearItsBorder) {
    const PointCloud truth = sampled(scene_of(grid_mesh(2, 1, 1, 1)), 2000);
    LitCloud scan = scan_of(truth);
    prepare_cloud(scan);
    EXPECT_NEAR(area_of(scan.points), 2, 0.04);
}

TEST(PrepareCloud, KeepsTheAreaOfUnevenPoints) {
    SampleConfig config;
    config.points = 20'000;
    config.pattern = SamplePattern::stratified;
    const PointCloud truth = sample_surface(scene_of(sphere_mesh(128, 64)), config);
    LitCloud scan = scan_of(truth);
    prepare_cloud(scan);
    EXPECT_NEAR(area_of(scan.points) / area_of(truth), 1, 0.02);
}

TEST(PrepareCloud, DropsOutliersAndPointsInOnePlace) {
    LitCloud scan = scanned_sphere();
    const std::size_t count = scan.points.size();
    scan.points.positions.insert(scan.points.positions.end(), {{0, 0, 0}, {3, 0, 0}, scan.points.positions[7]});
    scan.points.faces.resize(count + 3, 99'999);
    scan.irradiance.resize(count + 3);
    PrepareReport report;
    prepare_cloud(scan, {}, &report);
    EXPECT_EQ(report.outliers, 2U);
    EXPECT_EQ(report.duplicates, 1U);
    EXPECT_EQ(scan.points.size(), count);
    EXPECT_EQ(scan.irradiance.size(), count);
    EXPECT_EQ(std::ranges::count(scan.points.faces, 99'999U), 0);
    EXPECT_THAT(report.warnings,
                testing::IsSupersetOf({testing::HasSubstr("outliers"), testing::HasSubstr("dropped")}));
}

TEST(PrepareCloud, KeepsNormalsThatTheFileHas) {
    LitCloud scan = scanned_sphere();
    scan.points.normals.assign(scan.points.size(), V3f(0, 1, 0));
    prepare_cloud(scan);
    EXPECT_THAT(scan.points.normals, testing::Each(V3f(0, 1, 0)));
    EXPECT_EQ(scan.points.areas.size(), scan.points.size());
}

TEST(PrepareCloud, IsTheSameAtAnyNumberOfThreads) {
    LitCloud one = scanned_sphere();
    LitCloud four = one;
    {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
        prepare_cloud(one);
    }
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 4);
    prepare_cloud(four);
    EXPECT_EQ(one, four);
}

TEST(PrepareCloud, RefusesWhatIsNoSurface) {
    const auto cloud_of = [](std::vector<V3f> positions) {
        LitCloud cloud;
        cloud.points.positions = std::move(positions);
        return cloud;
    };
    std::vector<V3f> line;
    line.reserve(1000);
    for (int i = 0; i < 1000; ++i) line.emplace_back(V3d(1, 2, 3) * (0.001 * i * i));
    for (LitCloud cloud : {cloud_of({{1, 2, 3}}), cloud_of({{1, 2, 3}, {1, 2, 4}}),
                           cloud_of(std::vector<V3f>(500, V3f(1, 2, 3))), cloud_of(line)})
        EXPECT_THROW(prepare_cloud(cloud), UnsupportedInput);
}

TEST(PrepareCloud, MakesFiniteAnswersOfFewAndOddPoints) {
    std::vector<std::vector<V3f>> clouds{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                                         {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                         {{0, 0, 0}, {1e18F, 0, 0}, {0, 1e18F, 0}, {1, 1, 1}},
                                         {{0, 0, 0}, {1e-30F, 0, 0}, {0, 1e-30F, 0}, {1e-30F, 1e-30F, 0}}};
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(0, 1);
    clouds.emplace_back();
    for (int i = 0; i < 500; ++i) clouds.back().emplace_back(uniform(random), uniform(random), uniform(random));
    clouds.emplace_back();
    for (int i = 0; i < 900; ++i) clouds.back().emplace_back(i % 30, i / 30, 0);
    for (const std::vector<V3f>& positions : clouds) {
        LitCloud cloud;
        cloud.points.positions = positions;
        prepare_cloud(cloud);
        ASSERT_TRUE(is_complete(cloud.points));
        for (std::size_t i = 0; i < cloud.points.size(); ++i) {
            EXPECT_NEAR(cloud.points.normals[i].length(), 1, 1e-5);
            EXPECT_TRUE(std::isfinite(cloud.points.areas[i]));
        }
    }
}

}  // namespace
}  // namespace vmap
