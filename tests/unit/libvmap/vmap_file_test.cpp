// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud_scenes.h"

#include <vmap/build_patch_vmap.h>
#include <vmap/build_vmap.h>
#include <vmap/error.h>
#include <vmap/octree.h>
#include <vmap/patch_tree.h>
#include <vmap/vmap_file.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <fstream>

namespace vmap {
namespace {

using Bytes = std::vector<std::byte>;
using testing::HasSubstr;

VmapContents some_contents(PointCloud cloud, OctreeKind kind = OctreeKind::adaptive) {
    VmapContents contents;
    contents.source = "room.glb";
    contents.light_units = LightUnits::raw;
    contents.cloud = std::move(cloud);
    OctreeConfig config{.points_per_leaf = 16};
    if (kind == OctreeKind::uniform) config = {.kind = kind, .cell_size = 0.2};
    contents.tree = build_octree(contents.cloud, config);
    contents.map = build_vmap(contents.tree);
    LightSource spot;
    spot.kind = LightKind::spot;
    spot.name = "spot";
    spot.position = {0.5, 0.9, 0.5};
    contents.lights = {spot, LightSource{}};
    Camera camera;
    camera.name = "camera";
    camera.vertical_fov = 0.7;
    contents.cameras = {camera};
    contents.tree_seconds = 0.25;
    contents.map_seconds = 0.5;
    contents.extra["HITS"] = {std::byte{1}, std::byte{2}, std::byte{3}};
    return contents;
}

VmapContents some_patch_contents(PointCloud cloud) {
    VmapContents contents;
    contents.cloud = std::move(cloud);
    contents.patches = find_patches(contents.cloud);
    contents.tree = build_patch_tree(contents.cloud, contents.patches, {.points_per_leaf = 30});
    contents.map = build_patch_vmap(contents.cloud, contents.tree, contents.patches);
    return contents;
}

Bytes to_bytes(const VmapContents& contents) {
    Bytes bytes;
    write_vmap(contents,
               [&](std::span<const std::byte> piece) { bytes.insert(bytes.end(), piece.begin(), piece.end()); });
    return bytes;
}

class VmapFile : public testing::Test {
protected:
    void SetUp() override {
        path = std::filesystem::temp_directory_path() /
               ("vmap_file_test_" + std::to_string(::getpid()) + "_" +
                testing::UnitTest::GetInstance()->current_test_info()->name() + ".vmap");
    }
    void TearDown() override { std::filesystem::remove(path); }

    void save(const Bytes& bytes) const {
        std::ofstream file(path, std::ios::binary | std::ios::trunc);
        file.write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
    }

    /// The one line with which a file of these bytes is refused; empty when it is not.
    [[nodiscard]] std::string refusal(const Bytes& bytes) const {
        save(bytes);
        try {
            static_cast<void>(read_vmap(path));
        } catch (const FileError& error) {
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
            EXPECT_THAT(error.what(), HasSubstr(path.string()));
            return error.what();
        }
        return {};
    }

    std::filesystem::path path;
};

TEST_F(VmapFile, ComesBackAsItWas) {
    for (const OctreeKind kind : {OctreeKind::adaptive, OctreeKind::uniform}) {
        const VmapContents contents = some_contents(test::packed_room(800), kind);
        save(to_bytes(contents));
        const VmapContents back = read_vmap(path);
        EXPECT_EQ(back.source, contents.source);
        EXPECT_EQ(back.light_units, contents.light_units);
        EXPECT_TRUE(back.cloud == contents.cloud);
        EXPECT_TRUE(back.lights == contents.lights);
        ASSERT_EQ(back.cameras.size(), 1U);
        EXPECT_EQ(back.cameras[0].name, "camera");
        EXPECT_EQ(back.cameras[0].vertical_fov, 0.7);
        EXPECT_TRUE(back.tree == contents.tree);
        EXPECT_TRUE(back.map == contents.map);
        EXPECT_EQ(back.tree_seconds, 0.25);
        EXPECT_EQ(back.map_seconds, 0.5);
        EXPECT_EQ(back.extra, contents.extra);
    }
}

TEST_F(VmapFile, PatchesComeBackAsTheyWere) {
    const VmapContents contents = some_patch_contents(test::packed_room(2000));
    save(to_bytes(contents));
    const VmapContents back = read_vmap(path);
    EXPECT_TRUE(back.tree == contents.tree);
    EXPECT_TRUE(back.map == contents.map);
    EXPECT_FALSE(back.map.hidden.empty());
    EXPECT_EQ(back.patches.point_order, contents.patches.point_order);
    ASSERT_EQ(back.patches.patches.size(), contents.patches.patches.size());
    for (std::size_t p = 0; p < back.patches.patches.size(); ++p) {
        const Patch& was = contents.patches.patches[p];
        const Patch& is = back.patches.patches[p];
        EXPECT_TRUE(is.center == was.center && is.normal == was.normal && is.u == was.u && is.v == was.v);
        EXPECT_TRUE(is.first_point == was.first_point && is.point_count == was.point_count && is.area == was.area);
        EXPECT_TRUE(is.flat == was.flat && is.emits == was.emits);
        EXPECT_TRUE(std::ranges::equal(back.patches.outlines[p], contents.patches.outlines[p]));
    }
}

TEST_F(VmapFile, DegenerateCloudsComeBackAsTheyWere) {
    std::vector<test::NamedCloud> clouds = test::degenerate_clouds();
    clouds.push_back({"empty", {}});
    for (test::NamedCloud& scene : clouds) {
        SCOPED_TRACE(scene.name);
        const VmapContents contents = some_contents(std::move(scene.cloud));
        save(to_bytes(contents));
        const VmapContents back = read_vmap(path);
        EXPECT_TRUE(back.cloud == contents.cloud);
        EXPECT_TRUE(back.tree == contents.tree);
        EXPECT_TRUE(back.map == contents.map);
    }
}

TEST_F(VmapFile, SameContentsGiveTheSameBytes) {
    EXPECT_TRUE(to_bytes(some_contents(test::packed_room(300))) == to_bytes(some_contents(test::packed_room(300))));
}

TEST_F(VmapFile, RefusedWhenCutAtAnyByte) {
    const Bytes whole = to_bytes(some_contents(test::empty_room(60)));
    ASSERT_EQ(refusal(whole), "");
    for (std::size_t size = 0; size < whole.size(); size += 1 + size / 250)
        ASSERT_NE(refusal(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size))), "") << size;
}

TEST_F(VmapFile, RefusedWhenOneByteIsChangedAnywhere) {
    Bytes bytes = to_bytes(some_contents(test::empty_room(60)));
    for (std::size_t at = 0; at < bytes.size(); at += 1 + at / 600)
        for (const std::byte flip : {std::byte{1}, std::byte{0x80}, std::byte{0xFF}}) {
            bytes[at] ^= flip;
            ASSERT_NE(refusal(bytes), "") << at;
            bytes[at] ^= flip;
        }
    ASSERT_EQ(refusal(bytes), "");
}

TEST_F(VmapFile, RefusedWhenSomethingFollows) {
    Bytes bytes = to_bytes(some_contents(test::empty_room(60)));
    bytes.push_back(std::byte{0});
    EXPECT_THAT(refusal(bytes), HasSubstr("bytes; expected"));
}

TEST_F(VmapFile, SaysWhenItIsOfAnotherVersionOrKind) {
    Bytes bytes = to_bytes(some_contents(test::empty_room(60)));
    bytes[8] = std::byte{77};
    EXPECT_THAT(refusal(bytes), HasSubstr("version 77; expected 1"));
    bytes[0] = std::byte{'P'};
    EXPECT_THAT(refusal(bytes), HasSubstr("not a .vmap file"));
    EXPECT_THROW(static_cast<void>(read_vmap("/nowhere/x.vmap")), FileError);
    EXPECT_THROW(static_cast<void>(read_vmap("/")), FileError);
}

/// Contents that no builder makes, under sound checksums.
TEST_F(VmapFile, RefusesWhatIsInconsistent) {
    const VmapContents sound = some_contents(test::packed_room(400));
    std::vector<std::pair<std::string, std::function<void(VmapContents&)>>> faults{
        {"a child before its parent",
         [](auto& c) {
             c.tree.nodes[1].first_child = 0;
             c.tree.nodes[1].child_count = 2;
         }},
        {"a child beyond the end", [](auto& c) { c.tree.nodes[0].child_count = 1'000'000'000; }},
        {"a leaf beyond the end", [](auto& c) { c.tree.nodes[c.tree.leaves[0].node].leaf = 1'000'000; }},
        {"a leaf of another node", [](auto& c) { std::swap(c.tree.leaves[0].node, c.tree.leaves[1].node); }},
        {"a point twice", [](auto& c) { c.tree.point_order[0] = c.tree.point_order[1]; }},
        {"a point beyond the end", [](auto& c) { c.tree.point_order[0] = 4'000'000'000U; }},
        {"points of another cloud", [](auto& c) { c.cloud = test::packed_room(500); }},
        {"a node without points", [](auto& c) { c.tree.nodes.back().point_count = 0; }},
        {"a partner beyond the end", [](auto& c) { c.map.partners.back() = 1'000'000; }},
        {"a link that goes one way",
         [](auto& c) { c.map.partners.front() = static_cast<std::uint32_t>(c.tree.nodes.size()) - 1; }},
        {"links out of bounds", [](auto& c) { c.map.first_link[1] = ~std::uint64_t{0}; }},
        {"links of fewer nodes", [](auto& c) { c.map.first_link.pop_back(); }},
        {"no normals", [](auto& c) { c.cloud.normals.clear(); }},
        {"links under rule patch without patches", [](auto& c) { c.map.rule = VisibilityRule::patch; }},
        {"albedo for some", [](auto& c) { c.cloud.albedo.pop_back(); }},
    };
    for (const auto& [name, spoil] : faults) {
        SCOPED_TRACE(name);
        VmapContents contents = sound;
        spoil(contents);
        EXPECT_NE(refusal(to_bytes(contents)), "");
    }
}

TEST_F(VmapFile, RefusesInconsistentPatches) {
    const VmapContents sound = some_patch_contents(test::packed_room(1000));
    ASSERT_EQ(refusal(to_bytes(sound)), "");
    std::vector<std::pair<std::string, std::function<void(VmapContents&)>>> faults{
        {"a patch that is not there", [](auto& c) { c.tree.nodes.back().patch = 1'000'000; }},
        {"a leaf of no patch", [](auto& c) { c.tree.nodes.back().patch = no_index; }},
        {"points beyond the end", [](auto& c) { c.patches.patches.back().point_count = 4'000'000'000U; }},
        {"a patch too few", [](auto& c) { c.patches.patches.pop_back(); }},
        {"hidden nodes beyond the end", [](auto& c) { c.map.hidden.back() = 4'000'000; }},
        {"no hidden nodes", [](auto& c) { c.map.first_hidden.clear(); }},
    };
    for (const auto& [name, spoil] : faults) {
        SCOPED_TRACE(name);
        VmapContents contents = sound;
        spoil(contents);
        EXPECT_NE(refusal(to_bytes(contents)), "");
    }
}

TEST_F(VmapFile, AbsurdSizesAreRefusedAtOnce) {
    Bytes bytes = to_bytes(some_contents(test::packed_room(400)));
    const auto start = std::chrono::steady_clock::now();
    // Every eight bytes in turn become a huge number.
    for (std::size_t at = 16; at + 8 <= std::min<std::size_t>(bytes.size(), 4096); at += 4) {
        Bytes absurd = bytes;
        const std::uint64_t huge = ~std::uint64_t{0} >> 3;
        std::memcpy(absurd.data() + at, &huge, 8);
        ASSERT_NE(refusal(absurd), "") << at;
    }
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    EXPECT_LT(taken.count() / 1000, 0.1);
}

TEST_F(VmapFile, KnowsThePointsOfAnotherCloud) {
    const VmapContents contents = some_contents(test::packed_room(400));
    EXPECT_NO_THROW(require_same_points(contents, contents.cloud, "a.ply"));
    PointCloud other = contents.cloud;
    other.positions[7].x += 1e-6F;
    EXPECT_THROW(require_same_points(contents, other, "a.ply"), UnsupportedInput);
    EXPECT_THROW(require_same_points(contents, test::packed_room(500), "a.ply"), UnsupportedInput);
}

}  // namespace
}  // namespace vmap
