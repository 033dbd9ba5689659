// SPDX-License-Identifier: GPL-3.0-or-later
// tinygltf as an independent reader: it finds the same triangles, places and materials in the bundled scenes.
#include <vmap/importers/gltf.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

// Under a name of its own: Debian's libdraco exports a tinygltf of another version, and two in one process crash.
#define tinygltf peer_tinygltf
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace vmap::test {
namespace {

bool keep_images_packed(tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int, void*) {
    return true;
}

tinygltf::Model read_by_tinygltf(const std::filesystem::path& path) {
    tinygltf::TinyGLTF reader;
    reader.SetImageLoader(keep_images_packed, nullptr);
    tinygltf::Model model;
    std::string error;
    std::string warning;
    if (!reader.LoadASCIIFromFile(&model, &error, &warning, path.string())) throw std::runtime_error(error);
    return model;
}

template <class T>
std::vector<T> values_of(const tinygltf::Model& model, int index) {
    const tinygltf::Accessor& accessor = model.accessors.at(static_cast<std::size_t>(index));
    const tinygltf::BufferView& view = model.bufferViews.at(static_cast<std::size_t>(accessor.bufferView));
    std::vector<T> values(accessor.count);
    std::memcpy(
        static_cast<void*>(values.data()),
        model.buffers.at(static_cast<std::size_t>(view.buffer)).data.data() + view.byteOffset + accessor.byteOffset,
        accessor.count * sizeof(T));
    return values;
}

std::vector<std::filesystem::path> scene_files() {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(VMAP_SCENES))
        if (entry.path().extension() == ".gltf") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

const Instance* instance_named(const Scene& scene, const std::string& name) {
    for (const Instance& instance : scene.instances)
        if (instance.name == name) return &instance;
    return nullptr;
}

TEST(GltfPeer, ReadsTheSameFromTheBundledScenes) {
    ASSERT_FALSE(scene_files().empty());
    for (const std::filesystem::path& path : scene_files()) {
        SCOPED_TRACE(path.filename().string());
        const tinygltf::Model model = read_by_tinygltf(path);
        const Scene scene = import_gltf(path).scene;
        std::size_t placed = 0;
        for (const tinygltf::Node& node : model.nodes) {
            if (node.mesh < 0) continue;
            ++placed;
            SCOPED_TRACE(node.name);
            const Instance* const instance = instance_named(scene, node.name);
            ASSERT_NE(instance, nullptr);
            const Mesh& mesh = scene.meshes.at(instance->mesh);
            const tinygltf::Primitive& primitive =
                model.meshes.at(static_cast<std::size_t>(node.mesh)).primitives.at(0);
            EXPECT_EQ(mesh.positions, values_of<Imath::V3f>(model, primitive.attributes.at("POSITION")));
            const std::vector<std::uint16_t> indices = values_of<std::uint16_t>(model, primitive.indices);
            EXPECT_TRUE(std::equal(indices.begin(), indices.end(), mesh.indices.begin(), mesh.indices.end()));
            const tinygltf::Material& material = model.materials.at(static_cast<std::size_t>(primitive.material));
            EXPECT_EQ(scene.materials.at(mesh.material).name, material.name);
            for (int i = 0; i < 4; ++i)
                EXPECT_EQ(
                    scene.materials.at(mesh.material).base_color[i],
                    static_cast<float>(material.pbrMetallicRoughness.baseColorFactor.at(static_cast<std::size_t>(i))));
        }
        EXPECT_EQ(scene.instances.size(), placed);
        EXPECT_EQ(scene.cameras.size(), model.cameras.size());
        EXPECT_EQ(scene.lights.size(), model.lights.size());
    }
}

}  // namespace
}  // namespace vmap::test
