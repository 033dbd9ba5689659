// SPDX-License-Identifier: GPL-3.0-or-later
// The whole chain, from a scene's file to irradiance at its points, against light that is known in closed form.
#include <vmap/importers/input.h>
#include <vmap/importers/sample_surface.h>
#include <vmap/light.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

namespace vmap {
namespace {

using Imath::V3d;
using std::numbers::pi;

struct LitScene {
    Scene scene;
    LitCloud cloud;

    explicit LitScene(const std::filesystem::path& file, std::size_t points = 40000)
        : scene(read_input(file).scene), cloud{sample_surface(scene, config_of(points)), {}} {
        cloud.irradiance = compute_light(cloud.points, scene.lights).irradiance;
    }

    static SampleConfig config_of(std::size_t points) {
        SampleConfig config;
        config.points = points;
        return config;
    }

    [[nodiscard]] V3d position(std::size_t i) const { return cloud.points.origin + V3d(cloud.points.positions[i]); }

    [[nodiscard]] double emission(std::size_t i) const {
        return cloud.points.emits() ? static_cast<double>(cloud.points.emission[i].x) : 0;
    }
    /// L = Le + albedo E / pi, first channel.
    [[nodiscard]] double radiance(std::size_t i) const {
        return emission(i) +
               static_cast<double>(cloud.points.albedo[i].x) * static_cast<double>(cloud.irradiance[i].x) / pi;
    }

    /// Area-weighted mean over the points that a predicate picks.
    [[nodiscard]] double mean(const std::function<bool(std::size_t)>& picked,
                              const std::function<double(std::size_t)>& quantity) const {
        double sum = 0;
        double area = 0;
        for (std::size_t i = 0; i < cloud.points.size(); ++i) {
            if (!picked(i)) continue;
            sum += quantity(i) * static_cast<double>(cloud.points.areas[i]);
            area += static_cast<double>(cloud.points.areas[i]);
        }
        EXPECT_GT(area, 0);
        return sum / area;
    }
    [[nodiscard]] double mean_radiance(float albedo) const {
        return mean([&](std::size_t i) { return std::abs(cloud.points.albedo[i].x - albedo) < 1e-3F; },
                    [&](std::size_t i) { return radiance(i); });
    }
    [[nodiscard]] double mean_factor_of_the_dark() const {
        double lamp = 0;
        for (std::size_t i = 0; i < cloud.points.size(); ++i) lamp = std::max(lamp, emission(i));
        return mean([&](std::size_t i) { return emission(i) == 0; },
                    [&](std::size_t i) { return static_cast<double>(cloud.irradiance[i].x) / (pi * lamp); });
    }
    [[nodiscard]] double largest_irradiance(const std::function<bool(std::size_t)>& picked) const {
        double largest = 0;
        for (std::size_t i = 0; i < cloud.points.size(); ++i)
            if (picked(i)) largest = std::max(largest, static_cast<double>(cloud.irradiance[i].x));
        return largest;
    }
};

class AnalyticScenes : public testing::Test {
protected:
    void SetUp() override {
        if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder << ": ITS SCENES ARE NOT TESTED";
    }
    [[nodiscard]] LitScene lit(const std::string& name, std::size_t points = 40000) const {
        return LitScene(folder / name, points);
    }
    std::filesystem::path folder = std::filesystem::path(VMAP_SHARED) / "corpus" / "analytic-gi";
};

TEST_F(AnalyticScenes, FurnaceBoxes) {
    for (const auto& [name, expected] : std::vector<std::pair<std::string, double>>{
             {"rho00", 0.1}, {"rho20", 0.125}, {"rho50", 0.2}, {"rho80", 0.5}, {"rho90", 1}, {"rho95", 2}}) {
        const LitScene scene = lit("furnace_box_" + name + ".gltf", 10000);
        for (std::size_t i = 0; i < scene.cloud.points.size(); ++i)
            ASSERT_NEAR(scene.radiance(i) / expected, 1, 0.01) << name << " at " << scene.position(i);
    }
}

TEST_F(AnalyticScenes, FurnaceSpheres) {
    for (const std::string level : {"lv2", "lv3", "lv4"}) {
        const LitScene scene = lit("furnace_sphere_" + level + ".gltf");
        EXPECT_NEAR(scene.mean_radiance(0.5F), 1, 0.003) << level;
        std::size_t off = 0;
        for (std::size_t i = 0; i < scene.cloud.points.size(); ++i)
            if (std::abs(scene.radiance(i) - 1) > 0.01) ++off;
        EXPECT_LT(off, scene.cloud.points.size() / 50) << level;
    }
}

TEST_F(AnalyticScenes, IntegratingSpheres) {
    const LitScene zones = lit("sphere_two_zones.gltf");
    EXPECT_NEAR(zones.mean_radiance(0.2F) / 0.1957831, 1, 0.01);
    EXPECT_NEAR(zones.mean_radiance(0.8F) / 1.783132, 1, 0.01);
    EXPECT_NEAR(lit("sphere_cap_light.gltf").mean_radiance(0.7F) / 1.044182, 1, 0.01);
    EXPECT_NEAR(lit("sphere_black_cap.gltf").mean_radiance(0.9F) / 0.154064, 1, 0.01);
    EXPECT_NEAR(lit("sphere_pointlight.gltf").mean_radiance(0.5F), 1, 0.01);
}

TEST_F(AnalyticScenes, FormFactors) {
    for (const std::string n : {"n1", "n8", "n32"})
        EXPECT_NEAR(lit("plates_parallel_" + n + ".gltf").mean_factor_of_the_dark() / 0.199824895698, 1, 0.01) << n;
    for (const std::string n : {"n8", "n32"})
        EXPECT_NEAR(lit("plates_perpendicular_" + n + ".gltf").mean_factor_of_the_dark() / 0.200043776075, 1, 0.01)
            << n;
    EXPECT_NEAR(lit("discs_coaxial.gltf").mean_factor_of_the_dark() / 0.381966011250, 1, 0.01);
}

TEST_F(AnalyticScenes, SphereOverAPlane) {
    const LitScene scene = lit("sphere_over_plane.gltf");
    double lamp = 0;
    for (std::size_t i = 0; i < scene.cloud.points.size(); ++i) lamp = std::max(lamp, scene.emission(i));
    double difference = 0;
    double sum = 0;
    for (std::size_t i = 0; i < scene.cloud.points.size(); ++i) {
        if (scene.emission(i) > 0) continue;
        const V3d normal(scene.cloud.points.normals[i]);
        // Distance to the sphere's centre, which lies 2 above the plane.
        const V3d p = scene.position(i);
        const double expected = pi * lamp * 2 / std::pow(p.length2() - std::pow(normal.dot(p), 2) + 4, 1.5);
        difference += std::abs(static_cast<double>(scene.cloud.irradiance[i].x) - expected);
        sum += expected;
    }
    EXPECT_LT(difference / sum, 0.01);
}

TEST_F(AnalyticScenes, ABlockerHidesThePlateBehindIt) {
    const LitScene scene = lit("occluded_plates.gltf");
    // The lamp lies at z = 0 and faces up, the blocker at 0.5 faces both ways, the plate at 1 faces down.
    // Its border and theirs are one line seen from the plate's border: known from points, each to a part of a spacing.
    EXPECT_LT(scene.largest_irradiance([&](std::size_t i) { return scene.position(i).z > 0.9; }), 1e-3);
    EXPECT_EQ(scene.largest_irradiance([&](std::size_t i) {
        const V3d p = scene.position(i);
        return p.z > 0.9 && std::min({p.x, p.y, 1 - p.x, 1 - p.y}) > 0.01;
    }),
              0);
    const double received = scene.mean(
        [&](std::size_t i) { return std::abs(scene.position(i).z - 0.5) < 0.1 && scene.cloud.points.normals[i].z < 0; },
        [&](std::size_t i) { return static_cast<double>(scene.cloud.irradiance[i].x); });
    EXPECT_NEAR(received / (pi * 0.415253283577), 1, 0.002);
}

TEST_F(AnalyticScenes, NothingLeaksThroughSheets) {
    const LitScene cells = lit("box_two_cells_thin_wall.gltf");
    EXPECT_EQ(cells.largest_irradiance([&](std::size_t i) {
        const double x = cells.position(i).x;
        return x < 0.5 - 1e-6 || (x < 0.5 + 1e-6 && cells.cloud.points.normals[i].x < -0.5F);
    }),
              0);
    EXPECT_GT(cells.largest_irradiance([&](std::size_t i) { return cells.position(i).x > 0.5 + 1e-6; }), 0);
}

nlohmann::json expected_values() {
    std::ifstream file(std::filesystem::path(VMAP_SCENES) / "expected.json");
    return nlohmann::json::parse(file);
}

V3d vector_of(const nlohmann::json& values) {
    return {values[0].get<double>(), values[1].get<double>(), values[2].get<double>()};
}

std::vector<std::string> scenes_with_points() {
    std::vector<std::string> names;
    const nlohmann::json expected = expected_values();
    for (const auto& item : expected.items())
        if (item.value().contains("points")) names.push_back(item.key());
    return names;
}

class BundledSceneLight : public testing::TestWithParam<std::string> {};

TEST_P(BundledSceneLight, IsTheKnownOneNearThePointsThatAreTold) {
    const nlohmann::json expected = expected_values().at(GetParam());
    const LitScene scene(std::filesystem::path(VMAP_SCENES) / GetParam(), 100000);
    for (const nlohmann::json& told : expected.at("points")) {
        const V3d place = vector_of(told.at("position"));
        const V3d normal = vector_of(told.at("normal"));
        double nearest = std::numeric_limits<double>::max();
        std::size_t found = 0;
        for (std::size_t i = 0; i < scene.cloud.points.size(); ++i) {
            if (V3d(scene.cloud.points.normals[i]).dot(normal) < 0.99) continue;
            const double distance = (scene.position(i) - place).length();
            if (distance < nearest) {
                nearest = distance;
                found = i;
            }
        }
        // The nearest point lies a little beside the place that is told.
        for (int c = 0; c < 3; ++c) {
            const double answer = vector_of(told.at("irradiance"))[c];
            EXPECT_NEAR(static_cast<double>(scene.cloud.irradiance[found][c]), answer, 0.02 * answer) << "at " << place;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, BundledSceneLight, testing::ValuesIn(scenes_with_points()),
                         [](const auto& test) { return test.param.substr(0, test.param.find('.')); });

/// Whether a point lies behind the lamp that is drawn onto the ceiling of coincident_sheets.gltf.
bool is_behind_the_lamp(const LitScene& scene, std::size_t i) {
    const V3d p = scene.position(i);
    return scene.emission(i) == 0 && p.y > 2 - 1e-6 && std::abs(p.x) < 0.4 && std::abs(p.z) < 0.4;
}

// What is emitted is absorbed or leaves; light that vanishes between coincident sheets shows in no other way.
TEST(ClosedRooms, AbsorbWhatTheyEmit) {
    for (const std::string name : {"two_rooms.gltf", "thin_wall.gltf", "coincident_sheets.gltf"}) {
        const LitScene scene(std::filesystem::path(VMAP_SCENES) / name, 100000);
        double emitted = 0;
        double absorbed = 0;
        for (std::size_t i = 0; i < scene.cloud.points.size(); ++i) {
            if (name == "coincident_sheets.gltf" && is_behind_the_lamp(scene, i)) continue;
            const auto area = static_cast<double>(scene.cloud.points.areas[i]);
            emitted += pi * scene.emission(i) * area;
            absorbed += (1 - static_cast<double>(scene.cloud.points.albedo[i].x)) *
                        static_cast<double>(scene.cloud.irradiance[i].x) * area;
        }
        EXPECT_NEAR(absorbed / emitted, 1, 0.01) << name;
    }
}

}  // namespace
}  // namespace vmap
