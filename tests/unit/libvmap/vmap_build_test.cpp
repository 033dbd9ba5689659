// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud_scenes.h"

#include <vmap/build_vmap.h>
#include <vmap/leaf_ranges.h>
#include <vmap/leaf_visibility.h>
#include <vmap/octree.h>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <vector>

namespace vmap {
namespace {

/// Trees of both kinds with about this many leaves over every family of clouds.
void for_each_tree(std::size_t leaves, auto&& check) {
    for (const test::NamedCloud& scene : test::all_clouds(static_cast<int>(leaves) * 12))
        for (const OctreeKind kind : {OctreeKind::adaptive, OctreeKind::uniform}) {
            SCOPED_TRACE(scene.name + (kind == OctreeKind::uniform ? ", uniform" : ", adaptive"));
            OctreeConfig config = octree_config_for_leaves(scene.cloud, kind, leaves);
            if (kind == OctreeKind::adaptive) config = {.points_per_leaf = 16};
            check(build_octree(scene.cloud, config));
            if (testing::Test::HasFailure()) return;
        }
}

/// The definition, word for word.
bool sees_by_definition(const LeafVisibility& leaves, std::uint32_t a, std::uint32_t b) {
    if (!leaves.face_each_other(a, b)) return false;
    for (std::uint32_t k = 0; k < leaves.size(); ++k)
        if (leaves.may_block(k, a, b) && leaves.blocks(k, a, b)) return false;
    return true;
}

TEST(LeafVisibility, WalksFindEveryLeafThatBlocks) {
    for_each_tree(60, [](const Tree& tree) {
        const LeafVisibility leaves(tree);
        for (std::uint32_t a = 0; a < leaves.size(); ++a)
            for (std::uint32_t b = 0; b < leaves.size(); ++b) {
                ASSERT_EQ(leaves.sees(a, b), sees_by_definition(leaves, a, b)) << a << " " << b;
                ASSERT_EQ(leaves.sees(a, b), leaves.sees(b, a)) << a << " " << b;
            }
    });
}

TEST(VmapBuild, ThreeMethodsGiveEqualMaps) {
    for (const std::size_t size : {20, 150, 400})
        for_each_tree(size, [](const Tree& tree) {
            const VisibilityMap oracle = build_vmap(tree, VmapMethod::exhaustive);
            EXPECT_TRUE(build_vmap(tree, VmapMethod::seed) == oracle);
            EXPECT_TRUE(build_vmap(tree, VmapMethod::fast) == oracle);
        });
}

TEST(VmapBuild, EachVisiblePairOfLeavesIsUnderOneLinkAndNoOtherPairUnderAny) {
    for_each_tree(100, [](const Tree& tree) {
        const LeafVisibility leaves(tree);
        const VisibilityMap map = build_vmap(tree);
        const std::vector<LeafRange> ranges = leaf_ranges(tree);
        std::vector<int> links(leaves.size() * leaves.size());
        for (std::uint32_t n = 0; n < tree.nodes.size(); ++n)
            for (const std::uint32_t partner : map.links_of(n))
                for (std::uint32_t a = ranges[n].begin; a < ranges[n].end; ++a)
                    for (std::uint32_t b = ranges[partner].begin; b < ranges[partner].end; ++b)
                        ++links[a * leaves.size() + b];
        std::uint64_t visible = 0;
        for (std::uint32_t a = 0; a < leaves.size(); ++a)
            for (std::uint32_t b = 0; b < leaves.size(); ++b) {
                ASSERT_EQ(links[a * leaves.size() + b], leaves.sees(a, b) ? 1 : 0) << a << " " << b;
                visible += leaves.sees(a, b) ? 1 : 0;
            }
        EXPECT_EQ(visible_leaf_pairs(tree, map), visible);
    });
}

TEST(VmapBuild, IsTheSameAtAnyNumberOfThreads) {
    const Tree tree = build_octree(test::packed_room(30'000), {.points_per_leaf = 16});
    const VisibilityMap map = build_vmap(tree);
    for (const std::size_t threads : {1, 2, 5}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        EXPECT_TRUE(build_vmap(tree) == map);
    }
}

TEST(VmapBuild, SaysWhereItStandsAndCanBeStopped) {
    const Tree tree = build_octree(test::packed_room(30'000), {.points_per_leaf = 16});
    for (const VmapMethod method : {VmapMethod::fast, VmapMethod::seed}) {
        double last = 0;
        static_cast<void>(build_vmap(tree, method, [&](std::string_view, double fraction) {
            EXPECT_GE(fraction, last);
            EXPECT_LE(fraction, 1);
            last = fraction;
        }));
        EXPECT_GT(last, 0.5);
        struct Stop {};
        EXPECT_THROW(static_cast<void>(build_vmap(tree, method,
                                                  [](std::string_view, double fraction) {
                                                      if (fraction > 0.1) throw Stop();
                                                  })),
                     Stop);
    }
}

}  // namespace
}  // namespace vmap
