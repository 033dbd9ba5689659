// SPDX-License-Identifier: GPL-3.0-or-later
// Primitives of mode POINTS: foreign ones with what they have, our own without loss.
#include "gltf_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace vmap::test {
namespace {

using Imath::C3f;
using Imath::V3d;
using Imath::V3f;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

GltfFile three_points(json node = json::object()) {
    GltfFile file;
    const std::size_t positions = file.add_vectors({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    file.add_mesh({{"attributes", {{"POSITION", positions}}}, {"mode", 0}}, std::move(node));
    return file;
}

json& attributes_of(GltfFile& file) {
    return file.document["meshes"][0]["primitives"][0]["attributes"];
}

PointFile points_of(const GltfFile& file) {
    return file.import().points.value_or(PointFile());
}

TEST(GltfPoints, WhatIsMissingStaysEmpty) {
    const Input input = three_points().import();
    EXPECT_THAT(input.scene.instances, IsEmpty());
    ASSERT_TRUE(input.points.has_value());
    const PointCloud& points = input.points.value_or(PointFile()).cloud.points;
    EXPECT_EQ(points.size(), 3);
    EXPECT_THAT(points.normals, IsEmpty());
    EXPECT_THAT(points.areas, IsEmpty());
    EXPECT_THAT(points.albedo, IsEmpty());
    EXPECT_FALSE(input.points.value_or(PointFile()).ours);
}

TEST(GltfPoints, ColoursTimesTheBaseColourAreAlbedo) {
    GltfFile file = three_points();
    attributes_of(file)["COLOR_0"] = file.add_vectors({{1, 0.5F, 0}, {0.2F, 0.2F, 0.2F}, {4, 0, 0}});
    file.add("materials", {{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.5, 0.5, 1}}}}});
    file.document["meshes"][0]["primitives"][0]["material"] = 0;
    const Input input = file.import();
    EXPECT_THAT(input.points.value_or(PointFile()).cloud.points.albedo,
                ElementsAre(C3f(0.5F, 0.25F, 0), C3f(0.1F, 0.1F, 0.1F), C3f(1, 0, 0)));
    EXPECT_THAT(input.scene.warnings, testing::Contains(HasSubstr("clamped")));
}

TEST(GltfPoints, NodesMoveAndTurnThem) {
    GltfFile file = three_points({{"translation", {1e7, 2, 3}}, {"scale", {1, 1, -2}}});
    attributes_of(file)["NORMAL"] = file.add_vectors({{0, 0, 3}, {1, 0, 0}, {0, 1, 1}});
    const PointCloud points = points_of(file).cloud.points;
    EXPECT_EQ(points.origin, V3d(1e7, 2, 3));
    EXPECT_EQ(points.positions[1], V3f(1, 0, 0));
    EXPECT_EQ(points.normals[0], V3f(0, 0, -1));
    // A slope of 45 degrees becomes steeper in its normal: (0 1 1) over (1 1 -2) is (0 1 -0.5).
    EXPECT_LT((points.normals[2] - V3f(0, 1, -0.5F).normalized()).length(), 1e-6F);
}

TEST(GltfPoints, IndicesChooseAndOrderThem) {
    GltfFile file = three_points();
    file.document["meshes"][0]["primitives"][0]["indices"] = file.add_indices({2, 0, 2});
    EXPECT_THAT(points_of(file).cloud.points.positions, ElementsAre(V3f(0, 1, 0), V3f(0, 0, 0), V3f(0, 1, 0)));
}

TEST(GltfPoints, RadiusGivesTheirArea) {
    GltfFile file = three_points();
    file.document["meshes"][0]["extras"]["radius"] = 2;
    EXPECT_THAT(points_of(file).cloud.points.areas, Each(static_cast<float>(4 * std::numbers::pi)));
}

TEST(GltfPoints, AttributesThatSomeLackAreLeftOut) {
    GltfFile file = three_points();
    attributes_of(file)["NORMAL"] = file.add_vectors({{0, 0, 1}, {0, 0, 1}, {0, 0, 1}});
    attributes_of(file)["_ALBEDO"] = file.add_vectors({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}});
    json second = file.document["meshes"][0]["primitives"][0];
    second["attributes"].erase("NORMAL");
    file.document["meshes"][0]["primitives"].push_back(second);
    const PointCloud points = points_of(file).cloud.points;
    EXPECT_EQ(points.size(), 6);
    EXPECT_THAT(points.normals, IsEmpty());
    EXPECT_EQ(points.albedo.size(), 6);
}

TEST(GltfPoints, NormalsThatAreNoneAreNotUsed) {
    GltfFile file = three_points();
    attributes_of(file)["NORMAL"] = file.add_vectors({{0, 0, 1}, {0, 0, 0}, {0, 0, 1}});
    const Input input = file.import();
    EXPECT_THAT(input.points.value_or(PointFile()).cloud.points.normals, IsEmpty());
    EXPECT_THAT(input.scene.warnings, testing::Contains(HasSubstr("normals of points")));
}

TEST(GltfPoints, MeshesAndPointsTogether) {
    GltfFile file;
    file.add_triangle();
    file.add_mesh({{"attributes", {{"POSITION", 0}}}, {"mode", 0}});
    const Input input = file.import();
    EXPECT_EQ(input.scene.instances.size(), 1);
    EXPECT_EQ(input.points.value_or(PointFile()).cloud.points.size(), 3);
}

}  // namespace
}  // namespace vmap::test
