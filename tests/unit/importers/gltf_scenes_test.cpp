// SPDX-License-Identifier: GPL-3.0-or-later
// The importer agrees with what the script that made the scenes measured on them.
#include "measure.h"

#include <vmap/importers/gltf.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace vmap::test {
namespace {

nlohmann::json expected_values() {
    std::ifstream file(std::filesystem::path(VMAP_SCENES) / "expected.json");
    return nlohmann::json::parse(file);
}

std::vector<std::string> scene_names() {
    std::vector<std::string> names;
    const nlohmann::json expected = expected_values();
    for (const auto& item : expected.items()) names.push_back(item.key());
    return names;
}

class BundledScene : public testing::TestWithParam<std::string> {};

TEST_P(BundledScene, IsReadAsItWasMade) {
    const nlohmann::json expected = expected_values().at(GetParam());
    const Scene scene = import_gltf(std::filesystem::path(VMAP_SCENES) / GetParam()).scene;
    const Measure measure = measure_of(scene);
    EXPECT_EQ(measure.triangles, expected.at("triangles").get<std::size_t>());
    EXPECT_NEAR(measure.area, expected.at("area").get<double>(), 1e-7 * measure.area);
    EXPECT_NEAR(measure.lit_area, expected.at("lit_area").get<double>(), 1e-7 * measure.lit_area);
    EXPECT_NEAR(measure.emissive_area, expected.at("emissive_area").get<double>(), 1e-7 * measure.area);
    EXPECT_EQ(scene.lights.size(), expected.at("lights").get<std::size_t>());
    EXPECT_EQ(scene.cameras.size(), expected.at("cameras").get<std::size_t>());
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(measure.box.min[i], expected.at("box")[0][i].get<double>(), 1e-7);
        EXPECT_NEAR(measure.box.max[i], expected.at("box")[1][i].get<double>(), 1e-7);
    }
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
}

std::string test_name(const testing::TestParamInfo<std::string>& scene) {
    return scene.param.substr(0, scene.param.find('.'));
}

INSTANTIATE_TEST_SUITE_P(Scenes, BundledScene, testing::ValuesIn(scene_names()), test_name);

}  // namespace
}  // namespace vmap::test
