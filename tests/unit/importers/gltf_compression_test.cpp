// SPDX-License-Identifier: GPL-3.0-or-later
// Draco and meshopt: what their encoders write is read back, and damaged bytes are refused.
#include "gltf_file.h"
#include "measure.h"
#include "test_scenes.h"

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <cmath>
#include <cstring>

namespace vmap::test {
namespace {

using testing::HasSubstr;

// --- Draco ---

/// A compressed mesh and the number of vertices that it unpacks to.
struct DracoBytes {
    std::string bytes;
    std::size_t vertices = 0;
};

DracoBytes draco_bytes(const Mesh& mesh, bool edgebreaker, bool with_metadata) {
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(static_cast<int>(mesh.triangle_count()));
    const int positions = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    for (std::uint32_t f = 0; f < mesh.triangle_count(); ++f)
        builder.SetAttributeValuesForFace(positions, draco::FaceIndex(f), &mesh.positions[mesh.indices[3 * f]],
                                          &mesh.positions[mesh.indices[3 * f + 1]],
                                          &mesh.positions[mesh.indices[3 * f + 2]]);
    const std::unique_ptr<draco::Mesh> packed = builder.Finalize();
    if (with_metadata) {
        auto metadata = std::make_unique<draco::GeometryMetadata>();
        metadata->AddEntryString("author", "a test");
        packed->AddMetadata(std::move(metadata));
    }
    draco::Encoder encoder;
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 16);
    encoder.SetEncodingMethod(edgebreaker ? draco::MESH_EDGEBREAKER_ENCODING : draco::MESH_SEQUENTIAL_ENCODING);
    encoder.SetTrackEncodedProperties(true);
    draco::EncoderBuffer buffer;
    if (!encoder.EncodeMeshToBuffer(*packed, &buffer).ok()) throw std::runtime_error("Draco cannot encode the test");
    return {{buffer.data(), buffer.size()}, encoder.num_encoded_points()};
}

/// A sphere as Draco stores it; the accessors say what it decompresses to.
GltfFile draco_file(const std::string& bytes, std::size_t vertices, std::size_t indices) {
    GltfFile file;
    const std::size_t view = file.add_view(std::as_bytes(std::span(bytes)));
    file.add("accessors", {{"componentType", 5126}, {"type", "VEC3"}, {"count", vertices}});
    file.add("accessors", {{"componentType", 5125}, {"type", "SCALAR"}, {"count", indices}});
    file.document["extensionsUsed"] = {"KHR_draco_mesh_compression"};
    file.document["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    const json draco = {{"bufferView", view}, {"attributes", {{"POSITION", 0}}}};
    file.add_mesh(
        {{"attributes", {{"POSITION", 0}}}, {"indices", 1}, {"extensions", {{"KHR_draco_mesh_compression", draco}}}});
    return file;
}

constexpr std::size_t sphere_indices = static_cast<std::size_t>(3 * 2 * 16 * 7);

TEST(GltfDraco, BothMethodsAreReadWithOrWithoutMetadata) {
    const Mesh sphere = sphere_mesh(16, 8);
    for (const bool edgebreaker : {false, true})
        for (const bool metadata : {false, true}) {
            const DracoBytes packed = draco_bytes(sphere, edgebreaker, metadata);
            const Scene scene = draco_file(packed.bytes, packed.vertices, sphere_indices).import().scene;
            EXPECT_NEAR(measure_of(scene).area, measure_of(scene_of(sphere)).area, 1e-3);
            EXPECT_EQ(scene.meshes[0].positions.size(), packed.vertices);
        }
}

TEST(GltfDraco, AccessorsHaveToAgree) {
    const DracoBytes packed = draco_bytes(sphere_mesh(16, 8), true, false);
    EXPECT_THAT(complaint_about(draco_file(packed.bytes, packed.vertices, sphere_indices + 3).text()),
                HasSubstr("triangles"));
    EXPECT_THAT(complaint_about(draco_file(packed.bytes, packed.vertices + 1, sphere_indices).text()),
                HasSubstr("vertices"));
}

TEST(GltfDraco, DamagedBytesAreRefusedOrReadAsSomethingElse) {
    const auto [bytes, vertices] = draco_bytes(sphere_mesh(16, 8), true, false);
    for (std::size_t length = 0; length < bytes.size(); length += 13)
        EXPECT_NE(complaint_about(draco_file(bytes.substr(0, length), vertices, sphere_indices).text()), "") << length;
    for (std::size_t i = 0; i < bytes.size(); i += 7) {
        std::string damaged = bytes;
        damaged[i] = static_cast<char>(damaged[i] ^ 0x55);
        static_cast<void>(complaint_about(draco_file(damaged, vertices, sphere_indices).text()));
    }
}

TEST(GltfDraco, ClaimsOfBillionsAreRefusedBeforeMemoryIsTaken) {
    // Header 2.2, triangles, edgebreaker, no flags; then the traversal, 2^31 vertices and 2^30 triangles.
    const std::string bomb("DRACO\2\2\1\1\0\0\0\x80\x80\x80\x80\x08\x80\x80\x80\x80\x04\0\0\0\0\0\0\0\0", 30);
    EXPECT_THAT(complaint_about(draco_file(bomb, 1U << 31U, 3ULL << 30U).text()), HasSubstr("memory"));
}

// --- meshopt ---

template <class T>
std::string meshopt_vertices(const std::vector<T>& values) {
    std::vector<unsigned char> bytes(meshopt_encodeVertexBufferBound(values.size(), sizeof(T)));
    bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), values.data(), values.size(), sizeof(T)));
    return {bytes.begin(), bytes.end()};
}

std::string meshopt_triangles(const std::vector<std::uint32_t>& indices, std::size_t vertices) {
    std::vector<unsigned char> bytes(meshopt_encodeIndexBufferBound(indices.size(), vertices));
    bytes.resize(meshopt_encodeIndexBuffer(bytes.data(), bytes.size(), indices.data(), indices.size()));
    return {bytes.begin(), bytes.end()};
}

std::string meshopt_sequence(const std::vector<std::uint32_t>& indices, std::size_t vertices) {
    std::vector<unsigned char> bytes(meshopt_encodeIndexSequenceBound(indices.size(), vertices));
    bytes.resize(meshopt_encodeIndexSequence(bytes.data(), bytes.size(), indices.data(), indices.size()));
    return {bytes.begin(), bytes.end()};
}

/// Adds a compressed view over a fallback buffer that holds nothing; buffer 0 holds the compressed bytes.
std::size_t add_packed(GltfFile& file, const std::string& bytes, std::size_t count, std::size_t stride,
                       const char* mode, const char* filter = "NONE") {
    const std::size_t view = file.add_view(std::as_bytes(std::span(bytes)));
    json& stored = file.document["bufferViews"][view];
    json packed = stored;
    packed.update({{"count", count}, {"byteStride", stride}, {"mode", mode}, {"filter", filter}});
    stored = {{"buffer", 1},
              {"byteOffset", 0},
              {"byteLength", count * stride},
              {"extensions", {{"EXT_meshopt_compression", packed}}}};
    return view;
}

/// Both buffers can be described only when the first is complete.
std::string finished(const GltfFile& file) {
    GltfFile copy = file;
    copy.document["extensionsUsed"] = {"EXT_meshopt_compression", "KHR_mesh_quantization"};
    copy.document["extensionsRequired"] = copy.document["extensionsUsed"];
    const json fallback = {{"byteLength", 1U << 20U},
                           {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}};
    copy.document["buffers"] = {{{"byteLength", copy.buffer.size()}}, fallback};
    return copy.binary();
}

struct PackedSphere {
    Mesh mesh = sphere_mesh(16, 8);
    std::string positions = meshopt_vertices(mesh.positions);

    [[nodiscard]] std::string file(const char* mode, const std::string& indices) const {
        GltfFile file;
        const std::size_t position_view = add_packed(file, positions, mesh.positions.size(), 12, "ATTRIBUTES");
        const std::size_t index_view = add_packed(file, indices, mesh.indices.size(), 4, mode);
        file.add("accessors", {{"bufferView", position_view},
                               {"componentType", 5126},
                               {"type", "VEC3"},
                               {"count", mesh.positions.size()}});
        file.add(
            "accessors",
            {{"bufferView", index_view}, {"componentType", 5125}, {"type", "SCALAR"}, {"count", mesh.indices.size()}});
        file.add_mesh({{"attributes", {{"POSITION", 0}}}, {"indices", 1}});
        return finished(file);
    }
};

TEST(GltfMeshopt, AttributesAndBothFormsOfIndices) {
    const PackedSphere sphere;
    const double area = measure_of(scene_of(sphere.mesh)).area;
    const std::string triangles = meshopt_triangles(sphere.mesh.indices, sphere.mesh.positions.size());
    EXPECT_EQ(measure_of(import_content(sphere.file("TRIANGLES", triangles)).scene).area, area);
    const std::string sequence = meshopt_sequence(sphere.mesh.indices, sphere.mesh.positions.size());
    EXPECT_EQ(measure_of(import_content(sphere.file("INDICES", sequence)).scene).area, area);
}

TEST(GltfMeshopt, DamagedBytesAreRefusedOrReadAsSomethingElse) {
    const PackedSphere sphere;
    const std::string triangles = meshopt_triangles(sphere.mesh.indices, sphere.mesh.positions.size());
    for (std::size_t length = 1; length < triangles.size(); length += 7)
        EXPECT_NE(complaint_about(sphere.file("TRIANGLES", triangles.substr(0, length))), "") << length;
    for (std::size_t i = 0; i < triangles.size(); i += 11) {
        std::string damaged = triangles;
        damaged[i] = static_cast<char>(damaged[i] ^ 0x55);
        static_cast<void>(complaint_about(sphere.file("TRIANGLES", damaged)));
    }
    EXPECT_NE(complaint_about(sphere.file("ATTRIBUTES", triangles)), "");
    EXPECT_NE(complaint_about(sphere.file("INDICES", triangles)), "");
}

TEST(GltfMeshopt, OctahedralFilterGivesUnitNormals) {
    const Mesh sphere = sphere_mesh(8, 8);
    std::vector<float> normals;
    for (const V3f& normal : sphere.normals) normals.insert(normals.end(), {normal.x, normal.y, normal.z, 0});
    std::vector<std::array<std::int8_t, 4>> coded(sphere.normals.size());
    meshopt_encodeFilterOct(coded.data(), coded.size(), 4, 8, normals.data());
    GltfFile file;
    file.add_vectors(sphere.positions);
    const std::size_t view = add_packed(file, meshopt_vertices(coded), coded.size(), 4, "ATTRIBUTES", "OCTAHEDRAL");
    file.document["bufferViews"][view]["byteStride"] = 4;
    file.add("accessors", {{"bufferView", view},
                           {"componentType", 5120},
                           {"normalized", true},
                           {"type", "VEC3"},
                           {"count", coded.size()}});
    const std::vector<std::uint16_t> indices(sphere.indices.begin(), sphere.indices.end());
    file.add_mesh({{"attributes", {{"POSITION", 0}, {"NORMAL", 1}}}, {"indices", file.add_indices(indices)}});
    const Mesh mesh = import_content(finished(file)).scene.meshes.at(0);
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    for (std::size_t i = 0; i < mesh.normals.size(); ++i) EXPECT_GT(mesh.normals[i].dot(mesh.positions[i]), 0.98F);
}

TEST(GltfMeshopt, ExponentialFilterGivesFloats) {
    const Mesh sphere = sphere_mesh(8, 8);
    std::vector<std::array<std::uint32_t, 3>> coded(sphere.positions.size());
    meshopt_encodeFilterExp(coded.data(), coded.size(), 12, 15, &sphere.positions[0].x);
    GltfFile file;
    const std::size_t view = add_packed(file, meshopt_vertices(coded), coded.size(), 12, "ATTRIBUTES", "EXPONENTIAL");
    file.add("accessors", {{"bufferView", view}, {"componentType", 5126}, {"type", "VEC3"}, {"count", coded.size()}});
    const std::vector<std::uint16_t> indices(sphere.indices.begin(), sphere.indices.end());
    file.add_mesh({{"attributes", {{"POSITION", 0}}}, {"indices", file.add_indices(indices)}});
    const double area = measure_of(import_content(finished(file)).scene).area;
    EXPECT_NEAR(area / measure_of(scene_of(sphere)).area, 1, 1e-3);
}

TEST(GltfMeshopt, QuaternionFilterTurnsInstances) {
    const std::vector<float> quarter_turn{0, 0, std::sqrt(0.5F), std::sqrt(0.5F)};
    std::vector<std::array<std::int16_t, 4>> coded(1);
    meshopt_encodeFilterQuat(coded.data(), 1, 8, 16, quarter_turn.data());
    GltfFile file;
    file.add_triangle();
    const std::size_t view = add_packed(file, meshopt_vertices(coded), 1, 8, "ATTRIBUTES", "QUATERNION");
    const std::size_t rotation =
        file.add("accessors",
                 {{"bufferView", view}, {"componentType", 5122}, {"normalized", true}, {"type", "VEC4"}, {"count", 1}});
    file.document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["ROTATION"] = rotation;
    const Instance instance = import_content(finished(file)).scene.instances.at(0);
    EXPECT_LT((V3d(1, 0, 0) * instance.world_from_mesh - V3d(0, 1, 0)).length(), 1e-3);
}

TEST(GltfMeshopt, ClaimsBeyondWhatBytesCanHoldAreRefused) {
    const PackedSphere sphere;
    GltfFile file;
    add_packed(file, sphere.positions, 1U << 28U, 12, "ATTRIBUTES");
    file.add("accessors", {{"bufferView", 0}, {"componentType", 5126}, {"type", "VEC3"}, {"count", 3}});
    file.add_mesh({{"attributes", {{"POSITION", 0}}}});
    GltfFile large = file;
    large.document["bufferViews"][0]["byteLength"] = 1U << 20U;
    EXPECT_THAT(complaint_about(finished(large)), HasSubstr("memory"));
}

}  // namespace
}  // namespace vmap::test
