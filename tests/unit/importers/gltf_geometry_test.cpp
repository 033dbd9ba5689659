// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles of every mode and layout, and where nodes put them.
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
using testing::IsEmpty;

/// A strip of two squares in the plane z = 0, zigzag from below.
std::vector<V3f> zigzag() {
    return {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {2, 0, 0}, {2, 1, 0}};
}

V3d normal_of(const Scene& scene, std::size_t triangle) {
    return world_area_normal(scene, 0, triangle);
}

TEST(GltfGeometry, StripKeepsOneSideInFront) {
    GltfFile file;
    file.add_mesh({{"attributes", {{"POSITION", file.add_vectors(zigzag())}}}, {"mode", 5}});
    const Scene scene = file.import().scene;
    ASSERT_EQ(scene.meshes[0].triangle_count(), 4);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(normal_of(scene, i), V3d(0, 0, -1)) << i;
}

TEST(GltfGeometry, FanTurnsAboutItsFirstVertex) {
    GltfFile file;
    const std::size_t positions = file.add_vectors({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    file.add_mesh({{"attributes", {{"POSITION", positions}}}, {"mode", 6}});
    const Scene scene = file.import().scene;
    EXPECT_THAT(scene.meshes[0].indices, ElementsAre(1, 2, 0, 2, 3, 0));
    EXPECT_EQ(normal_of(scene, 1), V3d(0, 0, 1));
}

TEST(GltfGeometry, IndexedStripFollowsItsIndices) {
    GltfFile file;
    const std::size_t positions = file.add_vectors(zigzag());
    file.add_mesh(
        {{"attributes", {{"POSITION", positions}}}, {"indices", file.add_indices({0, 2, 1, 3})}, {"mode", 5}});
    const Scene scene = file.import().scene;
    EXPECT_EQ(scene.meshes[0].triangle_count(), 2);
    EXPECT_EQ(normal_of(scene, 0), V3d(0, 0, 1));
    EXPECT_EQ(normal_of(scene, 1), V3d(0, 0, 1));
}

TEST(GltfGeometry, LeftOverVerticesAreWarnedAbout) {
    GltfFile file;
    file.add_mesh(
        {{"attributes", {{"POSITION", file.add_vectors(zigzag())}}}, {"indices", file.add_indices({0, 1, 2, 3})}});
    const Scene scene = file.import().scene;
    EXPECT_EQ(scene.meshes[0].triangle_count(), 1);
    EXPECT_THAT(scene.warnings, testing::Contains(HasSubstr("whole triangle")));
}

TEST(GltfGeometry, UnusedVerticesAreLeftOut) {
    GltfFile file;
    file.add_mesh(
        {{"attributes", {{"POSITION", file.add_vectors(zigzag())}}}, {"indices", file.add_indices({1, 5, 3})}});
    const Mesh mesh = file.import().scene.meshes.at(0);
    EXPECT_THAT(mesh.positions, ElementsAre(V3f(0, 1, 0), V3f(1, 1, 0), V3f(2, 1, 0)));
    EXPECT_THAT(mesh.indices, ElementsAre(0, 2, 1));
}

TEST(GltfGeometry, FewIndicesIntoManyVertices) {
    GltfFile file;
    std::vector<V3f> positions(10000, V3f(7));
    positions[9000] = V3f(1, 0, 0);
    positions[9999] = V3f(0, 1, 0);
    file.add_mesh(
        {{"attributes", {{"POSITION", file.add_vectors(positions)}}}, {"indices", file.add_indices({9999, 3, 9000})}});
    const Mesh mesh = file.import().scene.meshes.at(0);
    EXPECT_THAT(mesh.positions, ElementsAre(V3f(7), V3f(1, 0, 0), V3f(0, 1, 0)));
    EXPECT_THAT(mesh.indices, ElementsAre(2, 0, 1));
}

TEST(GltfGeometry, InterleavedAttributes) {
    GltfFile file;
    const std::vector<float> vertices{0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 1};
    const std::size_t view = file.add_view(bytes_of(vertices));
    file.document["bufferViews"][view]["byteStride"] = 24;
    const json accessor = {{"bufferView", view}, {"componentType", 5126}, {"type", "VEC3"}, {"count", 3}};
    const std::size_t positions = file.add("accessors", accessor);
    const std::size_t normals = file.add("accessors", accessor);
    file.document["accessors"][normals]["byteOffset"] = 12;
    file.add_mesh({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}});
    const Mesh mesh = file.import().scene.meshes.at(0);
    EXPECT_EQ(mesh.positions[2], V3f(0, 1, 0));
    EXPECT_THAT(mesh.normals, testing::Each(V3f(0, 0, 1)));
}

TEST(GltfGeometry, QuantizedPositionsNeedTheExtension) {
    GltfFile file;
    const std::vector<std::int16_t> corners{0, 0, 0, 0, 32767, 0, 0, 0, 0, -32767, 0, 0};
    const std::size_t view = file.add_view(bytes_of(corners));
    file.document["bufferViews"][view]["byteStride"] = 8;
    const std::size_t positions =
        file.add("accessors",
                 {{"bufferView", view}, {"componentType", 5122}, {"type", "VEC3"}, {"count", 3}, {"normalized", true}});
    file.add_mesh({{"attributes", {{"POSITION", positions}}}}, {{"scale", {2, 2, 2}}});
    EXPECT_THAT(complaint_about(file.text()), HasSubstr("componentType"));

    file.document["extensionsUsed"] = {"KHR_mesh_quantization"};
    file.document["extensionsRequired"] = {"KHR_mesh_quantization"};
    const Scene scene = file.import().scene;
    EXPECT_THAT(scene.meshes[0].positions, ElementsAre(V3f(0), V3f(1, 0, 0), V3f(0, -1, 0)));
    EXPECT_DOUBLE_EQ(measure_of(scene).area, 2);
}

TEST(GltfGeometry, SparseValuesReplaceOthersAndZeros) {
    GltfFile file;
    const std::size_t full = file.add_vectors({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    const json sparse = {
        {"count", 2},
        {"indices",
         {{"bufferView", file.add_view(bytes_of(std::vector<std::uint16_t>{1, 2}))}, {"componentType", 5123}}},
        {"values", {{"bufferView", file.add_view(bytes_of(std::vector<V3f>{{3, 0, 0}, {0, 4, 0}}))}}}};
    file.document["accessors"][full]["sparse"] = sparse;
    const std::size_t zeros =
        file.add("accessors", {{"componentType", 5126}, {"type", "VEC3"}, {"count", 3}, {"sparse", sparse}});
    file.add_mesh({{"attributes", {{"POSITION", full}}}});
    file.add_mesh({{"attributes", {{"POSITION", zeros}}}, {"indices", file.add_indices({2, 0, 1})}});
    const Scene scene = file.import().scene;
    EXPECT_EQ(scene.meshes[0].positions, scene.meshes[1].positions);
    EXPECT_DOUBLE_EQ(measure_of(scene).area, 12);
}

TEST(GltfGeometry, NodesMultiplyFromTheRoot) {
    GltfFile file;
    file.add_triangle();
    const std::size_t mesh = file.document["nodes"][0]["mesh"];
    file.document["scenes"][0]["nodes"] = {0};
    const double half = std::sqrt(0.5);
    file.document["nodes"] = {
        {{"children", {1}}, {"translation", {10, 0, 0}}, {"rotation", {0, half, 0, half}}},
        {{"children", {2}}, {"scale", {2, 3, 4}}},
        {{"mesh", mesh}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}},
    };
    const Scene scene = file.import().scene;
    // (1 0 0) -> (6 6 7) -> (12 18 28) -> a quarter turn about y takes x to -z and z to x -> (28 18 -12) -> (38 18 -12)
    const V3d corner = V3d(1, 0, 0) * scene.instances.at(0).world_from_mesh;
    EXPECT_LT((corner - V3d(38, 18, -12)).length(), 1e-12);
}

TEST(GltfGeometry, MirroredNodesKeepTheirFrontOutside) {
    GltfFile file;
    file.add_triangle({{"scale", {-1, 1, 1}}});
    const Scene scene = file.import().scene;
    EXPECT_EQ(normal_of(scene, 0), V3d(0, 0, 1));
}

TEST(GltfGeometry, SharedMeshesAreStoredOnce) {
    GltfFile file;
    const std::size_t mesh = file.add_triangle();
    file.add_node({{"mesh", mesh}, {"name", "second"}, {"translation", {0, 0, 1}}});
    const Scene scene = file.import().scene;
    EXPECT_EQ(scene.meshes.size(), 1);
    ASSERT_EQ(scene.instances.size(), 2);
    EXPECT_EQ(scene.instances[1].name, "second");
    EXPECT_DOUBLE_EQ(measure_of(scene).area, 1);
}

TEST(GltfGeometry, BadNormalsGiveWayToTheFace) {
    GltfFile file;
    const std::size_t positions = file.add_vectors({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    const std::size_t normals = file.add_vectors({{0, 0, 0}, {NAN, 0, 0}, {0, 0, 2}});
    file.add_mesh({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}});
    const Scene scene = file.import().scene;
    EXPECT_THAT(scene.meshes[0].normals, ElementsAre(V3f(0), V3f(0), V3f(0, 0, 2)));
    EXPECT_THAT(scene.warnings, testing::Contains(HasSubstr("normals")));
}

TEST(GltfGeometry, LinesAreLeftOut) {
    GltfFile file;
    file.add_triangle();
    file.add_mesh({{"attributes", {{"POSITION", 0}}}, {"mode", 3}});
    const Scene scene = file.import().scene;
    EXPECT_EQ(scene.instances.size(), 1);
    EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("lines")));
}

TEST(GltfGeometry, HiddenNodesHideTheirChildren) {
    GltfFile file;
    file.add_triangle();
    file.add_triangle();
    file.document["extensionsUsed"] = {"KHR_node_visibility"};
    file.document["nodes"][1]["extensions"]["KHR_node_visibility"]["visible"] = false;
    file.document["nodes"][1]["children"] = {2};
    file.document["nodes"].push_back({{"mesh", 0}});
    EXPECT_EQ(file.import().scene.instances.size(), 1);
}

TEST(GltfGeometry, BeyondAllReasonIsRefused) {
    GltfFile file;
    file.add_triangle({{"scale", {1e20, 1, 1}}});
    EXPECT_THROW(static_cast<void>(file.import()), UnsupportedInput);
}

TEST(GltfGeometry, BinaryAndTextSayTheSame) {
    GltfFile file;
    file.add_triangle();
    const Scene text = file.import().scene;
    const Scene binary = import_content(file.binary()).scene;
    EXPECT_EQ(text.meshes[0].positions, binary.meshes[0].positions);
    EXPECT_EQ(text.meshes[0].indices, binary.meshes[0].indices);
    EXPECT_THAT(binary.warnings, IsEmpty());
}

}  // namespace
}  // namespace vmap::test
