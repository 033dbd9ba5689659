// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes that are bent, blended or repeated: morph targets, skins, instancing.
#include "gltf_file.h"
#include "measure.h"

#include <vmap/error.h>
#include <vmap/surface_shading.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace vmap::test {
namespace {

using Imath::V3d;
using Imath::V3f;
using testing::ElementsAre;
using testing::HasSubstr;

/// A triangle with two targets: the first lifts it by (0 0 1), the second stretches it along x.
GltfFile morphed_triangle() {
    GltfFile file;
    file.add_triangle();
    const std::size_t lift = file.add_vectors({{0, 0, 1}, {0, 0, 1}, {0, 0, 1}});
    const std::size_t stretch = file.add_vectors({{0, 0, 0}, {1, 0, 0}, {0, 0, 0}});
    file.document["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", lift}}, {{"POSITION", stretch}}};
    return file;
}

TEST(GltfPose, MorphWeightsOfTheMesh) {
    GltfFile file = morphed_triangle();
    EXPECT_EQ(file.import().scene.meshes[0].positions[1], V3f(1, 0, 0));  // without weights nothing moves
    file.document["meshes"][0]["weights"] = {0.5, 2};
    EXPECT_EQ(file.import().scene.meshes[0].positions[1], V3f(3, 0, 0.5));
}

TEST(GltfPose, NodesHaveWeightsOfTheirOwn) {
    GltfFile file = morphed_triangle();
    file.document["meshes"][0]["weights"] = {1, 0};
    file.add_node({{"mesh", 0}, {"weights", {0, 1}}});
    file.add_node({{"mesh", 0}});
    const Scene scene = file.import().scene;
    EXPECT_EQ(scene.meshes.size(), 2);
    EXPECT_EQ(scene.meshes[scene.instances[0].mesh].positions[1], V3f(1, 0, 1));
    EXPECT_EQ(scene.meshes[scene.instances[1].mesh].positions[1], V3f(2, 0, 0));
    EXPECT_EQ(scene.instances[0].mesh, scene.instances[2].mesh);
}

TEST(GltfPose, NormalsAndColoursAreMorphedToo) {
    GltfFile file = morphed_triangle();
    json& primitive = file.document["meshes"][0]["primitives"][0];
    primitive["attributes"]["NORMAL"] = file.add_vectors({{0, 0, 1}, {0, 0, 1}, {0, 0, 1}});
    primitive["attributes"]["COLOR_0"] = file.add_vectors({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
    primitive["targets"][0]["NORMAL"] = file.add_vectors({{1, 0, -1}, {0, 0, 0}, {0, 0, 0}});
    primitive["targets"][0]["COLOR_0"] = file.add_vectors({{1, 0.5, 0}, {0, 0, 0}, {0, 0, 0}});
    file.document["meshes"][0]["weights"] = {1, 0};
    const Mesh mesh = file.import().scene.meshes.at(0);
    EXPECT_EQ(mesh.normals[0], V3f(1, 0, 0));
    EXPECT_EQ(mesh.colors[0], Imath::C4f(1, 0.5F, 0, 1));
}

TEST(GltfPose, TargetsWithAnotherNumberOfVerticesAreRefused) {
    GltfFile file = morphed_triangle();
    file.document["meshes"][0]["primitives"][0]["targets"][0]["POSITION"] = file.add_vectors({{0, 0, 1}});
    EXPECT_THAT(complaint_about(file.text()), HasSubstr("1 elements for 3 vertices"));
}

/// A triangle whose first two vertices follow joint 0 and whose third follows joint 1; nodes 1 and 2 are the joints.
GltfFile skinned_triangle() {
    GltfFile file;
    file.add_triangle({{"skin", 0}, {"translation", {100, 100, 100}}});
    json& attributes = file.document["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] =
        file.add_accessor(bytes_of(std::vector<std::uint8_t>{0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0}), 5121, "VEC4", 3);
    attributes["WEIGHTS_0"] = file.add_floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
    file.add_node({{"translation", {0, 0, 5}}});
    file.add_node({{"scale", {1, 3, 1}}});
    file.document["skins"] = json::array({{{"joints", {1, 2}}}});
    return file;
}

TEST(GltfPose, VerticesFollowTheirJointsAndNotTheirNode) {
    const Scene scene = skinned_triangle().import().scene;
    EXPECT_THAT(scene.meshes[0].positions, ElementsAre(V3f(0, 0, 5), V3f(1, 0, 5), V3f(0, 3, 0)));
    EXPECT_EQ(scene.instances[0].world_from_mesh, Imath::M44d());
}

TEST(GltfPose, InverseBindMatricesComeFirst) {
    GltfFile file = skinned_triangle();
    const std::vector<float> shift_and_unit{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 7, 0, 0, 1,
                                            1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    file.document["skins"][0]["inverseBindMatrices"] = file.add_floats(shift_and_unit, "MAT4");
    EXPECT_EQ(file.import().scene.meshes[0].positions[0], V3f(7, 0, 5));
}

TEST(GltfPose, WeightsNeedNotSumToOne) {
    GltfFile file = skinned_triangle();
    file.document["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] =
        file.add_floats({0.5F, 0, 0, 0, 0.5F, 0, 0, 0, 4, 0, 0, 0}, "VEC4");
    EXPECT_EQ(file.import().scene.meshes[0].positions[2], V3f(0, 3, 0));
}

TEST(GltfPose, MirroringJointsTurnTheWindingBack) {
    GltfFile file = skinned_triangle();
    file.document["nodes"][1] = {{"scale", {-1, 1, 1}}};
    file.document["nodes"][2] = {{"scale", {-1, 1, 1}}};
    const Scene scene = file.import().scene;
    EXPECT_EQ(world_area_normal(scene, 0, 0), V3d(0, 0, 1));
}

TEST(GltfPose, JointsThatAreNotThereAreRefused) {
    GltfFile file = skinned_triangle();
    file.document["skins"][0]["joints"] = {1};
    EXPECT_THAT(complaint_about(file.text()), HasSubstr("joint 1 of 1"));
}

TEST(GltfPose, InstancingPlacesTheMeshManyTimes) {
    GltfFile file;
    file.add_triangle({{"translation", {0, 0, 1}}});
    const float half = std::sqrt(0.5F);
    const json attributes = {{"TRANSLATION", file.add_vectors({{1, 0, 0}, {0, 2, 0}})},
                             {"ROTATION", file.add_floats({0, 0, half, half, 0, 0, 0, 1}, "VEC4")},
                             {"SCALE", file.add_vectors({{2, 2, 2}, {1, -1, 1}})}};
    file.document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = attributes;
    file.document["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
    const Scene scene = file.import().scene;
    ASSERT_EQ(scene.instances.size(), 2);
    // A quarter turn about z takes (1 0 0), doubled, to (0 2 0); then come the instance's place and the node's.
    EXPECT_LT((V3d(1, 0, 0) * scene.instances[0].world_from_mesh - V3d(1, 2, 1)).length(), 1e-6);
    EXPECT_TRUE(is_mirrored(scene.instances[1]));
    EXPECT_EQ(world_area_normal(scene, 1, 0), V3d(0, 0, 1));
}

TEST(GltfPose, TooManyInstancesAreRefused) {
    GltfFile file;
    file.add_triangle();
    const std::size_t many = file.add("accessors", {{"componentType", 5126}, {"type", "VEC3"}, {"count", 1U << 30U}});
    file.document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = many;
    EXPECT_THROW(static_cast<void>(file.import()), UnsupportedInput);
}

}  // namespace
}  // namespace vmap::test
