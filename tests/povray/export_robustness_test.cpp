// SPDX-License-Identifier: GPL-3.0-or-later
#include "pov_picture.h"

#include <vmap/error.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>

namespace vmap {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class PovRobustness : public PovRayTest {
protected:
    /// The picture of a scene that should look like a white square.
    void expect_white(const Scene& scene) const {
        PovConfig config;
        config.width = config.height = 8;
        EXPECT_NEAR(render(scene, config).at(2, 5).x, 1, 0.001);
    }
};

TEST_F(PovRobustness, ForeignNamesCannotBreakOut) {
    const std::string evil = "\"}*/ %s%n \\\n#declare x = { \x1b[31m\xff\r\n//";
    Scene scene = square_under_sun();
    scene.source = evil;
    scene.meshes[0].name = evil;
    scene.materials[0].name = evil;
    scene.instances[0].name = evil;
    scene.lights[0].name = evil;
    scene.cameras[0].name = evil;
    expect_white(scene);
    EXPECT_EQ(content("scene.pov").find('\x1b'), std::string::npos);
}

TEST_F(PovRobustness, OddFileNamesWork) {
    Scene scene = square_under_sun();
    scene.images.push_back({.name = "", .width = 1, .height = 1, .rgba = {255, 255, 255, 255}});
    scene.materials[0].base_color_texture = TextureView();
    PovConfig config;
    config.bounces = 0;
    const PovExport result = write_pov_scene(scene, path("a b%\"c.pov"), {}, config);
    EXPECT_THAT(result.files, ElementsAre(path("a b%\"c.pov"), path("a_b__c-albedo-0.png")));
    EXPECT_THAT(content("a b%\"c.pov"), HasSubstr("povray +I'a b%\"c.pov' +Oa_b__c.exr"));
    std::filesystem::rename(path("a b%\"c.pov"), path("renamed.pov"));
    EXPECT_NEAR(render_file("renamed.pov", 8, 8).at(4, 4).x, 1, 0.001);
}

TEST_F(PovRobustness, DegenerateGeometryIsExportedValidly) {
    Scene scene = square_under_sun();
    Mesh mesh = scene.meshes[0];
    mesh.indices.insert(mesh.indices.end(), {0, 0, 1, 2, 2, 2});
    mesh.positions.emplace_back(0.0F, -1e-30F, 0.0F);
    mesh.texcoords[0].emplace_back(0.0F, 0.0F);
    mesh.indices.insert(mesh.indices.end(), {0, 4, 1});
    scene.meshes[0] = mesh;
    Mesh empty = mesh;
    empty.indices.clear();
    scene.meshes.push_back(empty);
    add_instance(scene, 1);
    Mesh collapsed = mesh;
    collapsed.indices = {0, 0, 1};
    scene.meshes.push_back(collapsed);
    add_instance(scene, 2);
    add_instance(scene, 0, scaled({0, 0, 0}));
    expect_white(scene);
}

TEST_F(PovRobustness, FlattenedInstanceKeepsItsShape) {
    Scene scene = square_under_sun();
    scene.instances[0].world_from_mesh = scaled({1, 1, 0});
    expect_white(scene);
}

TEST_F(PovRobustness, SceneWithoutCameraGetsOneAndAWarning) {
    Scene scene = square_under_sun();
    scene.source = "room.glb";
    scene.cameras.clear();
    PovConfig config;
    config.bounces = 0;
    const PovExport result = write_pov_scene(scene, path("scene.pov"), {}, config);
    EXPECT_THAT(result.warnings, ElementsAre("room.glb: no camera, one is placed to see everything"));
    EXPECT_NEAR(render_file("scene.pov", 40, 40).at(20, 20).x, 1, 0.001);
}

TEST_F(PovRobustness, NumbersThatAreNotFiniteAreRefusedAndLeaveNothing) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto expect_refused = [&](const Scene& scene) {
        EXPECT_THROW(write_pov_scene(scene, path("scene.pov"), {}), UnsupportedInput);
        EXPECT_EQ(file_count(), 0U);
    };
    Scene scene = square_under_sun();
    scene.meshes[0].positions[1].y = nan;
    expect_refused(scene);
    scene = square_under_sun();
    scene.lights[0].intensity.x = std::numeric_limits<float>::infinity();
    expect_refused(scene);
    scene = square_under_sun();
    scene.materials[0].emission.z = nan;
    expect_refused(scene);
    scene = square_under_sun();
    scene.instances[0].world_from_mesh[3][1] = nan;
    expect_refused(scene);
}

TEST_F(PovRobustness, NormalsThatAreNotFiniteLeaveTheMeshFlat) {
    Scene scene = square_under_sun();
    scene.meshes[0].normals.assign(4, Imath::V3f(1, 0, std::numeric_limits<float>::quiet_NaN()));
    PovConfig config;
    config.width = config.height = 8;
    config.shading_normals = true;
    EXPECT_NEAR(render(scene, config).at(4, 4).x, 1, 0.001);
}

TEST_F(PovRobustness, ConfigurationsOutOfRangeAreUsageErrors) {
    PovConfig config;
    config.bounces = 21;
    EXPECT_THROW(write_pov_scene(square_under_sun(), path("scene.pov"), {}, config), UsageError);
    config.bounces = 3;
    config.width = 0;
    EXPECT_THROW(write_pov_scene(square_under_sun(), path("scene.pov"), {}, config), UsageError);
    EXPECT_EQ(file_count(), 0U);
}

TEST_F(PovRobustness, FailureOfAnImageLeavesNoSceneBehind) {
    Scene scene = square_under_sun();
    scene.images.push_back({.name = "", .width = 1, .height = 1, .rgba = {255, 255, 255, 255}});
    scene.materials[0].base_color_texture = TextureView();
    std::filesystem::create_directory(path("scene-albedo-0.png"));
    EXPECT_THROW(write_pov_scene(scene, path("scene.pov"), {}), FileError);
    EXPECT_EQ(file_count(), 1U);
    EXPECT_THROW(write_pov_scene(scene, "-", {}), UsageError);
}

TEST_F(PovRobustness, HeaderHoldsTheCommandAndTheUnits) {
    PovConfig config;
    config.preset = PovPreset::reference;
    config.width = 320;
    config.height = 240;
    OutputInfo info;
    info.source = "room.glb";
    write_pov_scene(square_under_sun(), path("scene.pov"), info, config);
    const std::string text = content("scene.pov");
    EXPECT_THAT(text, HasSubstr("povray +Iscene.pov +Oscene.exr +FE +W320 +H240"));
    EXPECT_THAT(text, HasSubstr("// room.glb\n"));
    EXPECT_THAT(text, HasSubstr("recursion_limit 12\n"));
    EXPECT_THAT(text, HasSubstr("assumed_gamma 1\n"));
}

TEST_F(PovRobustness, PresetsParse) {
    for (const PovPreset preset : {PovPreset::draft, PovPreset::normal, PovPreset::reference}) {
        PovConfig config;
        config.preset = preset;
        write_pov_scene(square_under_sun(), path("scene.pov"), {}, config);
        EXPECT_NEAR(render_file("scene.pov", 4, 4).at(2, 2).x, 1, 0.001);
    }
}

/// A grid of half a million triangles, with texture coordinates.
TEST_F(PovRobustness, HalfAMillionTrianglesTakeTwoSecondsAtMost) {
    constexpr int side = 500;
    Scene scene = square_under_sun();
    Mesh& mesh = scene.meshes[0];
    mesh = Mesh();
    mesh.texcoords.resize(1);
    for (int i = 0; i < (side + 1) * (side + 1); ++i) {
        const int column = i % (side + 1), row = i / (side + 1);
        const float x = static_cast<float>(column) / side, y = static_cast<float>(row) / side;
        mesh.positions.emplace_back(2 * x - 1, 2 * y - 1, 0.0F);
        mesh.texcoords[0].emplace_back(x, y);
    }
    for (std::uint32_t y = 0; y < side; ++y) {
        for (std::uint32_t x = 0; x < side; ++x) {
            const std::uint32_t a = y * (side + 1) + x, b = a + 1, c = a + side + 1, d = c + 1;
            mesh.indices.insert(mesh.indices.end(), {a, b, d, a, d, c});
        }
    }
    scene.images.push_back({.name = "", .width = 1, .height = 1, .rgba = {255, 255, 255, 255}});
    scene.materials[0].base_color_texture = TextureView();
    const auto start = std::chrono::steady_clock::now();
    PovConfig config;
    config.bounces = 0;
    write_pov_scene(scene, path("scene.pov"), {}, config);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    EXPECT_LT(seconds.count(), 2);
    RecordProperty("seconds", std::to_string(seconds.count()));
    EXPECT_NEAR(render_file("scene.pov", 8, 8).at(4, 4).x, 1, 0.001);
}

TEST_F(PovRobustness, AMillionLightsAreExported) {
    Scene scene = square_under_sun();
    LightSource light;
    light.position = {0, 0, 1};
    light.intensity = Imath::C3f(1e-6F);
    scene.lights.assign(1000000, light);
    EXPECT_NO_THROW(write_pov_scene(scene, path("scene.pov"), {}));
    EXPECT_GT(std::filesystem::file_size(path("scene.pov")), 100000000U);
}

}  // namespace
}  // namespace vmap
