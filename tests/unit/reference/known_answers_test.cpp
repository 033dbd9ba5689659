// SPDX-License-Identifier: GPL-3.0-or-later
// The reference against scenes in files whose light is known in closed form.
#include <reference/reference_tracer.h>
#include <vmap/importers/input.h>

#include "surface_points.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

namespace vmap::reference {
namespace {

using Imath::V3d;
using std::numbers::pi;
using test::face_of;
using test::points_on;

std::vector<ReferenceValue> trace(const Scene& scene, const std::vector<ReferencePoint>& points,
                                  std::size_t samples = 1024) {
    return trace_irradiance(scene, points, {.samples = samples});
}

nlohmann::json expected_values() {
    std::ifstream file(std::filesystem::path(VMAP_SCENES) / "expected.json");
    return nlohmann::json::parse(file);
}

/// The bundled scenes that say what irradiance is at some points or everywhere.
std::vector<std::string> scenes_with_answers() {
    std::vector<std::string> names;
    const nlohmann::json expected = expected_values();
    for (const auto& item : expected.items())
        if (item.value().contains("points") || item.value().contains("irradiance_everywhere"))
            names.push_back(item.key());
    return names;
}

V3d vector_of(const nlohmann::json& values) {
    return {values[0].get<double>(), values[1].get<double>(), values[2].get<double>()};
}

class BundledScene : public testing::TestWithParam<std::string> {};

TEST_P(BundledScene, HasTheKnownIrradiance) {
    const nlohmann::json expected = expected_values().at(GetParam());
    const Scene scene = read_input(std::filesystem::path(VMAP_SCENES) / GetParam()).scene;
    std::vector<ReferencePoint> points;
    std::vector<V3d> answers;
    if (expected.contains("points"))
        for (const nlohmann::json& point : expected.at("points")) {
            points.push_back({.position = vector_of(point.at("position")), .normal = vector_of(point.at("normal"))});
            answers.push_back(vector_of(point.at("irradiance")));
        }
    if (expected.contains("irradiance_everywhere")) {
        double area_each = 0;
        points = points_on(scene, 30, area_each);
        answers.assign(points.size(), vector_of(expected.at("irradiance_everywhere")));
    }
    const std::vector<ReferenceValue> values = trace(scene, points);
    for (std::size_t i = 0; i < points.size(); ++i)
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(values[i].irradiance[c], answers[i][c], 5 * values[i].standard_error[c] + 1e-5 * answers[i][c])
                << "at " << points[i].position;
}

std::string test_name(const testing::TestParamInfo<std::string>& scene) {
    return scene.param.substr(0, scene.param.find('.'));
}

INSTANTIATE_TEST_SUITE_P(Scenes, BundledScene, testing::ValuesIn(scenes_with_answers()), test_name);

// In a closed room every watt that is emitted is absorbed; light that vanishes between sheets would show here only.
TEST(ClosedScene, AbsorbsWhatItEmits) {
    for (const std::string name : {"two_rooms.gltf", "thin_wall.gltf"}) {
        const Scene scene = read_input(std::filesystem::path(VMAP_SCENES) / name).scene;
        double area_each = 0;
        const std::vector<ReferencePoint> points = points_on(scene, 20000, area_each);
        const std::vector<ReferenceValue> values = trace(scene, points, 16);
        double absorbed = 0;
        double emitted = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Material& material = face_of(scene, points[i].face).material;
            absorbed += (1 - material.base_color.r) * values[i].irradiance.x * area_each;
            emitted += pi * material.emission.x * area_each;
        }
        // The emitters' share of the points is known to about one in a hundred.
        EXPECT_NEAR(absorbed / emitted, 1, 0.02) << name;
    }
}

class AnalyticCorpus : public testing::Test {
protected:
    void SetUp() override {
        if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder << ": its scenes are not tested";
    }
    [[nodiscard]] Scene scene(const std::string& name) const { return read_input(folder / name).scene; }

    /// Area mean of radiance Le + rho E / pi (first channel) over the places that a predicate picks, and its error.
    struct Mean {
        double value = 0;
        double error = 0;
        std::size_t count = 0;
    };
    static Mean mean_of(const Scene& scene, std::size_t points, std::size_t samples,
                        const std::function<bool(const ReferencePoint&, const Material&)>& picked,
                        const std::function<double(double irradiance, const Material&)>& quantity) {
        double area_each = 0;
        std::vector<ReferencePoint> chosen = points_on(scene, points, area_each);
        std::erase_if(chosen,
                      [&](const ReferencePoint& point) { return !picked(point, face_of(scene, point.face).material); });
        const std::vector<ReferenceValue> values = trace(scene, chosen, samples);
        Mean mean{.count = chosen.size()};
        double squares = 0;
        for (std::size_t i = 0; i < chosen.size(); ++i) {
            const double q = quantity(values[i].irradiance.x, face_of(scene, chosen[i].face).material);
            mean.value += q / static_cast<double>(chosen.size());
            squares += q * q / static_cast<double>(chosen.size());
        }
        mean.error = std::sqrt(std::max(0.0, squares - mean.value * mean.value) / static_cast<double>(chosen.size()));
        return mean;
    }
    static double radiance(double irradiance, const Material& material) {
        return material.emission.x + material.base_color.r * irradiance / pi;
    }
    static bool anywhere(const ReferencePoint& /*point*/, const Material& /*material*/) { return true; }

    std::filesystem::path folder = std::filesystem::path(VMAP_SHARED) / "corpus" / "analytic-gi";
};

TEST_F(AnalyticCorpus, Furnaces) {
    for (const auto& [name, expected] : std::vector<std::pair<std::string, double>>{{"furnace_box_rho00.gltf", 0.1},
                                                                                    {"furnace_box_rho50.gltf", 0.2},
                                                                                    {"furnace_box_rho95.gltf", 2},
                                                                                    {"furnace_sphere_lv3.gltf", 1}}) {
        const Mean mean = mean_of(scene(name), 400, 64, anywhere, radiance);
        EXPECT_NEAR(mean.value / expected, 1, 0.003) << name;
    }
}

TEST_F(AnalyticCorpus, IntegratingSpheres) {
    const auto zone = [&](const std::string& name, float albedo) {
        const auto picked = [albedo](const ReferencePoint& /*point*/, const Material& material) {
            return std::abs(material.base_color.r - albedo) < 1e-4F;
        };
        return mean_of(scene(name), 600, 64, picked, radiance).value;
    };
    // The mesh is a little smaller than the sphere that the answers are for.
    EXPECT_NEAR(zone("sphere_two_zones.gltf", 0.2F) / 0.1957831, 1, 0.01);
    EXPECT_NEAR(zone("sphere_two_zones.gltf", 0.8F) / 1.783132, 1, 0.01);
    EXPECT_NEAR(zone("sphere_cap_light.gltf", 0.7F) / 1.044182, 1, 0.01);
    EXPECT_NEAR(zone("sphere_black_cap.gltf", 0.9F) / 0.154064, 1, 0.01);
    EXPECT_NEAR(zone("sphere_pointlight.gltf", 0.5F), 1, 0.01);
}

TEST_F(AnalyticCorpus, FormFactors) {
    const auto factor = [&](const std::string& name) {
        const auto dark = [](const ReferencePoint& /*point*/, const Material& material) { return !material.emits(); };
        const Scene plates = scene(name);
        const auto lamp = std::find_if(plates.materials.begin(), plates.materials.end(),
                                       [](const Material& material) { return material.emits(); });
        const double emission = lamp->emission.x;
        return mean_of(plates, 4000, 64, dark, [emission](double irradiance, const Material& /*material*/) {
            return irradiance / (pi * emission);
        });
    };
    const Mean parallel = factor("plates_parallel_n1.gltf");
    EXPECT_NEAR(parallel.value, 0.199824895698, 4 * parallel.error);
    EXPECT_LT(parallel.error, 0.001);
    const Mean perpendicular = factor("plates_perpendicular_n8.gltf");
    EXPECT_NEAR(perpendicular.value, 0.200043776075, 4 * perpendicular.error);
    const Mean discs = factor("discs_coaxial.gltf");
    EXPECT_NEAR(discs.value, 0.381966011250, 4 * discs.error + 0.001);
}

TEST_F(AnalyticCorpus, SheetsBackToBackLeakNothing) {
    const auto dark_cell = [](const ReferencePoint& point, const Material& /*material*/) {
        return point.position.x < 0.5 - 1e-6;
    };
    const auto irradiance = [](double value, const Material& /*material*/) { return value; };
    const Mean dark = mean_of(scene("box_two_cells_thin_wall.gltf"), 2000, 256, dark_cell, irradiance);
    EXPECT_GT(dark.count, 500U);
    EXPECT_EQ(dark.value, 0);

    // The lit cell keeps all of its light: in a closed cell it is absorbed.
    const Scene cells = scene("box_two_cells_thin_wall.gltf");
    double area_each = 0;
    double absorbed = 0;
    double emitted = 0;
    std::vector<ReferencePoint> points = points_on(cells, 8000, area_each);
    const std::vector<ReferenceValue> values = trace(cells, points, 16);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Material& material = face_of(cells, points[i].face).material;
        emitted += pi * material.emission.x * area_each;
        absorbed += (1 - material.base_color.r) * values[i].irradiance.x * area_each;
    }
    EXPECT_NEAR(absorbed / emitted, 1, 0.01);
}

}  // namespace
}  // namespace vmap::reference
