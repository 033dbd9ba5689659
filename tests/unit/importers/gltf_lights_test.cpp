// SPDX-License-Identifier: GPL-3.0-or-later
// Lights and cameras: their places, directions and units.
#include "gltf_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace vmap::test {
namespace {

using Imath::C3f;
using Imath::V3d;
using testing::HasSubstr;

GltfFile lit_triangle(const json& light, json node = json::object()) {
    GltfFile file;
    file.add_triangle();
    file.document["extensionsUsed"] = {"KHR_lights_punctual"};
    file.document["extensions"]["KHR_lights_punctual"]["lights"] = {light};
    node["extensions"]["KHR_lights_punctual"]["light"] = 0;
    file.add_node(std::move(node));
    return file;
}

LightSource only_light(const GltfFile& file, LightUnits units = LightUnits::compat) {
    return file.import({.scene = {}, .light_units = units, .up = {}}).scene.lights.at(0);
}

TEST(GltfLights, NumbersMeanWhatTheUnitsSay) {
    const GltfFile point = lit_triangle({{"type", "point"}, {"color", {1, 0.5, 0}}, {"intensity", 683}});
    EXPECT_EQ(only_light(point).intensity, C3f(683, 341.5F, 0));
    EXPECT_NEAR(only_light(point, LightUnits::spec).intensity.x, 1, 1e-6);
    EXPECT_NEAR(only_light(point, LightUnits::raw).intensity.x, 683 / (4 * std::numbers::pi), 1e-5);
    const GltfFile sun = lit_triangle({{"type", "directional"}, {"intensity", 683}});
    EXPECT_EQ(only_light(sun).intensity, C3f(683, 683, 683));
    EXPECT_NEAR(only_light(sun, LightUnits::spec).intensity.x, 1, 1e-6);
    EXPECT_EQ(only_light(sun, LightUnits::raw).intensity.x, 683);
}

TEST(GltfLights, ScalesMoveLightsAndDoNotChangeThem) {
    const double half = std::sqrt(0.5);
    const LightSource light = only_light(lit_triangle(
        {{"type", "spot"}, {"intensity", 2}, {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.3}}}},
        {{"name", "lamp"}, {"translation", {1, 2, 3}}, {"rotation", {half, 0, 0, half}}, {"scale", {5, 5, 5}}}));
    EXPECT_EQ(light.kind, LightKind::spot);
    EXPECT_EQ(light.name, "lamp");
    EXPECT_EQ(light.position, V3d(1, 2, 3));
    EXPECT_LT((light.direction - V3d(0, 1, 0)).length(), 1e-12);  // a quarter turn about x takes -z to y
    EXPECT_EQ(light.intensity, C3f(2, 2, 2));
    EXPECT_EQ(light.inner_cone_angle, 0.1);
    EXPECT_EQ(light.outer_cone_angle, 0.3);
}

TEST(GltfLights, DefaultsOfTheSpecification) {
    const LightSource spot = only_light(lit_triangle({{"type", "spot"}, {"spot", json::object()}}));
    EXPECT_EQ(spot.intensity, C3f(1, 1, 1));
    EXPECT_EQ(spot.inner_cone_angle, 0);
    EXPECT_DOUBLE_EQ(spot.outer_cone_angle, std::numbers::pi / 4);
}

TEST(GltfLights, RangeIsWarnedAbout) {
    const Scene scene = lit_triangle({{"type", "point"}, {"range", 3}}).import().scene;
    EXPECT_THAT(scene.warnings, testing::ElementsAre(HasSubstr("range")));
}

TEST(GltfLights, LightsOfOtherScenesStayOut) {
    GltfFile file = lit_triangle({{"type", "point"}});
    file.document["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
    EXPECT_TRUE(file.import().scene.lights.empty());
}

TEST(GltfLights, LightsWithoutDirectionAreLeftOut) {
    const Scene scene = lit_triangle({{"type", "directional"}}, {{"scale", {0, 0, 0}}}).import().scene;
    EXPECT_TRUE(scene.lights.empty());
    EXPECT_THAT(scene.warnings, testing::ElementsAre(HasSubstr("direction")));
}

TEST(GltfCameras, AreRigidWhateverTheirNodesScale) {
    GltfFile file;
    file.add_triangle();
    file.add("cameras",
             {{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"aspectRatio", 1.5}, {"znear", 1}}}});
    file.add("cameras",
             {{"type", "orthographic"}, {"orthographic", {{"xmag", 4}, {"ymag", 2}, {"znear", 0}, {"zfar", 9}}}});
    const double half = std::sqrt(0.5);
    file.add_node({{"camera", 0}, {"name", "eye"}, {"scale", {2, 3, -4}}, {"translation", {1, 2, 3}}});
    file.add_node({{"camera", 1}, {"rotation", {0, half, 0, half}}});
    const Scene scene = file.import().scene;
    ASSERT_EQ(scene.cameras.size(), 2);
    const Camera& eye = scene.cameras[0];
    EXPECT_EQ(eye.name, "eye");
    EXPECT_EQ(eye.vertical_fov, 0.7);
    EXPECT_EQ(eye.aspect, 1.5);
    EXPECT_NEAR(eye.world_from_camera.determinant(), 1, 1e-12);
    EXPECT_LT((V3d(0, 0, -1) * eye.world_from_camera - V3d(1, 2, 4)).length(), 1e-12);
    const Camera& side = scene.cameras[1];
    EXPECT_TRUE(side.orthographic);
    EXPECT_EQ(side.half_height, 2);
    EXPECT_EQ(side.aspect, 2);
    EXPECT_LT((V3d(0, 0, -1) * side.world_from_camera - V3d(-1, 0, 0)).length(), 1e-12);
}

}  // namespace
}  // namespace vmap::test
