// SPDX-License-Identifier: GPL-3.0-or-later
// The document as a whole: scenes, extensions, containers, and what a damaged or hostile file gets.
#include "gltf_file.h"

#include <vmap/error.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/stat.h>

#include <optional>
#include <random>
#include <string>

namespace vmap::test {
namespace {

using testing::HasSubstr;

TEST(GltfDocument, ScenesAreChosenByNameOrIndex) {
    GltfFile file;
    file.add_triangle({{"name", "a"}});
    file.add_triangle({{"name", "b"}});
    file.document["scenes"] = {{{"name", "first"}, {"nodes", {0}}}, {{"name", "0"}, {"nodes", {1}}}};
    const auto name = [&](std::optional<std::string> scene) {
        return file.import({.scene = std::move(scene), .light_units = LightUnits::compat, .up = {}})
            .scene.instances.at(0)
            .name;
    };
    EXPECT_EQ(name("first"), "a");
    EXPECT_EQ(name("0"), "b");  // names come first
    EXPECT_EQ(name("1"), "b");
    EXPECT_EQ(name({}), "a");
    file.document["scene"] = 1;
    EXPECT_EQ(name({}), "b");
    file.document.erase("scene");
    EXPECT_EQ(name({}), "a");
    EXPECT_THROW(name("third"), UsageError);
    EXPECT_THROW(name("2"), UsageError);
}

TEST(GltfDocument, ExtensionsThatAreRequiredAndUnknownAreNamed) {
    GltfFile file;
    file.add_triangle();
    file.document["extensionsRequired"] = {"VENDOR_magic"};
    try {
        static_cast<void>(file.import());
        ADD_FAILURE();
    } catch (const UnsupportedInput& error) {
        EXPECT_THAT(error.what(), HasSubstr("VENDOR_magic"));
    }
}

TEST(GltfDocument, ExtensionsAreAskedForBeforeAnythingElse) {
    GltfFile file;
    file.document["extensionsRequired"] = {"VENDOR_magic"};
    file.document["accessors"] = "nonsense";
    EXPECT_THAT(complaint_about(file.text()), HasSubstr("VENDOR_magic"));
}

TEST(GltfDocument, ForeignNamesCannotSteerATerminal) {
    GltfFile file;
    file.add_triangle({{"name", "red\x1b[31m\nnext"}});
    EXPECT_EQ(file.import().scene.instances[0].name, "red\\x1b[31m\\nnext");
    file.document["nodes"][0]["mesh"] = "\x1b]0;title\x07";
    EXPECT_THAT(complaint_about(file.text()), HasSubstr("'\\x1b]0;title\\x07'"));
}

TEST(GltfDocument, DeepNestingInTheTextIsRefused) {
    for (const char* const bracket : {"[", "{\"a\":"}) {
        std::string text = R"({"asset":{"version":"2.0"},"extras":)";
        for (int i = 0; i < 100000; ++i) text += bracket;
        EXPECT_THAT(complaint_about(text), HasSubstr("nests deeper"));
    }
}

TEST(GltfDocument, DeepTreesOfNodesAreWalked) {
    GltfFile file;
    file.add_triangle();
    constexpr std::size_t depth = 50000;
    json nodes = json::array();
    for (std::size_t i = 0; i < depth; ++i) nodes.push_back({{"children", {i + 1}}, {"translation", {1, 0, 0}}});
    nodes.push_back({{"mesh", 0}});
    file.document["nodes"] = nodes;
    EXPECT_EQ(file.import().scene.instances.at(0).world_from_mesh[3][0], depth);
}

TEST(GltfDocument, OneTriangleUsedTooOftenIsRefused) {
    // The same bytes named again and again would cost memory without end.
    GltfFile file;
    file.add_vectors(std::vector<Imath::V3f>(3000, Imath::V3f(1)));
    json primitives = json::array();
    for (int i = 0; i < 20000; ++i) primitives.push_back({{"attributes", {{"POSITION", 0}}}});
    file.add("meshes", {{"primitives", primitives}});
    file.add_node({{"mesh", 0}});
    EXPECT_THAT(complaint_about(file.text()), HasSubstr("memory"));
}

TEST(GltfDocument, ElementsThatAreNotStoredCostNothing) {
    GltfFile file;
    const std::size_t positions =
        file.add("accessors", {{"componentType", 5126}, {"type", "VEC3"}, {"count", 2'000'000'000}});
    file.add_mesh({{"attributes", {{"POSITION", positions}}}});
    EXPECT_THAT(complaint_about(file.text()), HasSubstr("memory"));
    // With three indices only three of them are ever made.
    file.document["meshes"][0]["primitives"][0]["indices"] = file.add_indices({0, 1, 2});
    EXPECT_EQ(file.import().scene.meshes[0].positions.size(), 1 + 2);
}

TEST(GltfDocument, CutOffFilesAreRefused) {
    GltfFile file;
    file.add_triangle();
    for (const std::string& content : {file.text(), file.binary()})
        for (std::size_t length = 0; length < content.size(); length += length < 64 ? 1 : 7)
            EXPECT_NE(complaint_about(content.substr(0, length)), "") << length;
}

/// Changes a few bytes, more often to values that numbers and texts are full of.
std::string damaged(std::string content, std::mt19937& random) {
    constexpr std::string_view favourites = "0123456789-.e\"[]{},:";
    for (unsigned changes = 1 + random() % 4; changes > 0; --changes) {
        char& byte = content[random() % content.size()];
        byte = random() % 4 == 0 ? static_cast<char>(random()) : favourites[random() % favourites.size()];
    }
    return content;
}

TEST(GltfDocument, DamagedFilesAreReadOrRefused) {
    GltfFile file;
    file.add_triangle({{"translation", {1, 2, 3}}, {"scale", {1, 2, 1}}});
    file.document["meshes"][0]["primitives"][0]["indices"] = file.add_indices({0, 1, 2});
    const TestFolder folder;
    const std::filesystem::path path = folder.path() / "damaged";
    std::mt19937 random(1);
    for (int i = 0; i < 400; ++i) {
        write_file(path, damaged(i % 2 == 0 ? file.text() : file.binary(), random));
        try {
            static_cast<void>(import_gltf(path));
        } catch (const Error&) {
            // any complaint of ours will do
            continue;
        }
    }
}

TEST(GltfDocument, SpecialFilesAreRefusedWithoutWaiting) {
    const TestFolder folder;
    const std::filesystem::path pipe = folder.path() / "pipe.gltf";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_THROW(static_cast<void>(import_gltf(pipe)), FileError);
    EXPECT_THROW(static_cast<void>(import_gltf(folder.path())), FileError);
    EXPECT_THROW(static_cast<void>(import_gltf(folder.path() / "missing.gltf")), FileError);
}

TEST(GltfDocument, BuffersMayBeFilesBesideIt) {
    const TestFolder folder;
    GltfFile file;
    file.add_triangle();
    file.document["buffers"] = {{{"byteLength", file.buffer.size()}, {"uri", "data/mesh%201.bin"}}};
    write_file(folder.path() / "scene.gltf", file.text());
    EXPECT_THROW(static_cast<void>(import_gltf(folder.path() / "scene.gltf")), FileError);
    std::filesystem::create_directory(folder.path() / "data");
    write_file(folder.path() / "data" / "mesh 1.bin", file.buffer + "more than is needed");
    EXPECT_EQ(import_gltf(folder.path() / "scene.gltf").scene.instances.size(), 1);
    write_file(folder.path() / "data" / "mesh 1.bin", file.buffer.substr(1));
    EXPECT_THROW(static_cast<void>(import_gltf(folder.path() / "scene.gltf")), FileError);
}

TEST(GltfDocument, EmptyScenesAreRefused) {
    GltfFile file;
    EXPECT_THAT(complaint_about(file.text()), HasSubstr("neither surface nor points"));
    file.add_triangle();
    file.document["scenes"] = {json::object()};
    EXPECT_THAT(complaint_about(file.text()), HasSubstr("neither surface nor points"));
    file.document.erase("scenes");
    file.document.erase("scene");
    EXPECT_THAT(complaint_about(file.text()), HasSubstr("no scene"));
}

}  // namespace
}  // namespace vmap::test
