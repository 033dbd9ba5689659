// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud_scenes.h"

#include <vmap/build_patch_vmap.h>
#include <vmap/leaf_ranges.h>
#include <vmap/patch_tree.h>
#include <vmap/patch_visibility.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace vmap {
namespace {

/// A cloud with its patches and the tree over them.
struct Patched {
    Patched(PointCloud c, std::size_t leaves) : cloud(std::move(c)) {
        if (cloud.areas.empty()) cloud.areas.resize(cloud.size(), 0.01F);
        set = find_patches(cloud);
        tree = build_patch_tree(cloud, set, patch_tree_config_for_leaves(cloud, set, leaves));
    }

    PointCloud cloud;
    PatchSet set;
    Tree tree;
};

void for_each_patched(int points, std::size_t leaves, auto&& check) {
    for (test::NamedCloud& scene : test::all_clouds(points)) {
        SCOPED_TRACE(scene.name);
        check(Patched(std::move(scene.cloud), leaves));
        if (testing::Test::HasFailure()) return;
    }
}

TEST(PatchTree, EveryPointIsInOneLeafAndEveryLeafInOnePatch) {
    for_each_patched(1500, 200, [](const Patched& p) {
        std::vector<int> seen(p.cloud.size());
        std::uint32_t next = 0;
        for (const TreeLeaf& leaf : p.tree.leaves) {
            const TreeNode& node = p.tree.nodes[leaf.node];
            ASSERT_EQ(node.first_point, next);
            next += node.point_count;
            ASSERT_NE(node.patch, no_index);
            const auto of_patch = p.set.points_of(p.set.patches[node.patch]);
            for (const std::uint32_t i : p.tree.points_of(node)) {
                ++seen[i];
                ASSERT_NE(std::ranges::find(of_patch, i), of_patch.end());
            }
        }
        EXPECT_EQ(std::ranges::count(seen, 1), std::ssize(p.cloud.positions));
        for (const TreeNode& node : p.tree.nodes) ASSERT_NE(node.child_count, 1U);
    });
}

TEST(PatchVmap, ThreeMethodsGiveEqualMaps) {
    for (const std::size_t leaves : {30, 200})
        for (const std::uint32_t few : {0, 4})
            for_each_patched(500, leaves, [few](const Patched& p) {
                const auto build = [&](VmapMethod method) {
                    return build_patch_vmap(p.cloud, p.tree, p.set, {.method = method, .few_patches = few});
                };
                const VisibilityMap oracle = build(VmapMethod::exhaustive);
                EXPECT_TRUE(build(VmapMethod::seed) == oracle);
                EXPECT_TRUE(build(VmapMethod::fast) == oracle);
            });
}

/// How often each ordered pair of leaves is under one of some pairs of nodes.
std::vector<int> count_leaf_pairs(const Tree& tree, const auto& partners_of) {
    const std::vector<LeafRange> ranges = leaf_ranges(tree);
    std::vector<int> count(tree.leaves.size() * tree.leaves.size());
    for (std::uint32_t n = 0; n < tree.nodes.size(); ++n)
        for (const std::uint32_t partner : partners_of(n))
            for (std::uint32_t a = ranges[n].begin; a < ranges[n].end; ++a)
                for (std::uint32_t b = ranges[partner].begin; b < ranges[partner].end; ++b)
                    ++count[a * tree.leaves.size() + b];
    return count;
}

TEST(PatchVmap, EachVisiblePairOfLeavesIsUnderOneLinkAndNoOtherPairUnderAny) {
    for_each_patched(500, 60, [](const Patched& p) {
        const VisibilityMap map = build_patch_vmap(p.cloud, p.tree, p.set);
        const PatchVisibility visibility(p.cloud, p.tree, p.set);
        const std::vector<int> links = count_leaf_pairs(p.tree, [&](std::uint32_t n) { return map.links_of(n); });
        const std::vector<int> hidden = count_leaf_pairs(p.tree, [&](std::uint32_t n) { return map.hidden_from(n); });
        const std::size_t leaves = p.tree.leaves.size();
        for (std::uint32_t a = 0; a < leaves; ++a)
            for (std::uint32_t b = a + 1; b < leaves; ++b) {
                const std::uint32_t node_a = p.tree.leaves[a].node;
                const std::uint32_t node_b = p.tree.leaves[b].node;
                const Facing facing = visibility.facing(node_a, node_b);
                bool entered = false;
                for (std::uint32_t k = 0; k < p.set.patches.size(); ++k)
                    entered |=
                        facing == Facing::all && visibility.enters(k, node_a, node_b, visibility.shaft(node_a, node_b));
                const std::size_t at = a * leaves + b;
                if (facing == Facing::all && !entered) {
                    ASSERT_EQ(links[at], 1) << a << " " << b;
                }
                ASSERT_LE(links[at] + hidden[at], 1);
                ASSERT_EQ(links[b * leaves + a], links[at]);
                ASSERT_EQ(hidden[b * leaves + a], hidden[at]);
                if (links[at] + hidden[at] == 0) continue;
                for (const std::uint32_t x : p.tree.points_of(p.tree.nodes[node_a]))
                    for (const std::uint32_t y : p.tree.points_of(p.tree.nodes[node_b]))
                        ASSERT_EQ(visibility.sees(x, y), links[at] == 1);
            }
    });
}

/// The seed's promise, held by the points themselves.
TEST(PatchVmap, EveryPointUnderALinkSeesEveryPointUnderIt) {
    std::mt19937 random(1);
    for (const std::uint32_t few : {0, 8})
        for_each_patched(1200, 150, [&](const Patched& p) {
            const VisibilityMap map = build_patch_vmap(p.cloud, p.tree, p.set, {.few_patches = few});
            const PatchVisibility visibility(p.cloud, p.tree, p.set);
            const auto any_point = [&](std::uint32_t n) {
                const auto points = p.tree.points_of(p.tree.nodes[n]);
                return points[random() % points.size()];
            };
            for (std::uint32_t n = 0; n < p.tree.nodes.size(); ++n) {
                for (const std::uint32_t partner : map.links_of(n))
                    for (int i = 0; i < 8; ++i) ASSERT_TRUE(visibility.sees(any_point(n), any_point(partner)));
                for (const std::uint32_t partner : map.hidden_from(n))
                    for (int i = 0; i < 8; ++i) ASSERT_FALSE(visibility.sees(any_point(n), any_point(partner)));
            }
        });
}

TEST(PatchVmap, AnEmptyRoomIsOneLinkForEachPairOfWalls) {
    const Patched p(test::empty_room(6000), 600);
    ASSERT_EQ(p.set.patches.size(), 6U);
    const VisibilityMap map = build_patch_vmap(p.cloud, p.tree, p.set);
    EXPECT_EQ(map.ordered_links(), 30U);
    EXPECT_TRUE(map.hidden.empty());
}

TEST(PatchVmap, AScreenHidesWhatIsBehindIt) {
    // Two small squares that face each other, and between them a large one with two sides.
    PointCloud cloud;
    const auto add_square = [&](float x, float half, float normal) {
        constexpr float spacing = 0.05F;
        const int columns = static_cast<int>(std::lround(2 * half / spacing));
        for (int i = 0; i < columns * columns; ++i) {
            const auto at = [&](int k) { return (static_cast<float>(k) + 0.5F) * spacing - half; };
            cloud.positions.emplace_back(x, at(i % columns), at(i / columns));
            cloud.normals.emplace_back(normal, 0, 0);
            cloud.areas.push_back(spacing * spacing);
        }
    };
    add_square(-1, 0.3F, 1);
    add_square(1, 0.3F, -1);
    add_square(0.01F, 1, 1);
    add_square(-0.01F, 1, -1);
    const Patched p(cloud, 1);
    const VisibilityMap map = build_patch_vmap(p.cloud, p.tree, p.set);
    EXPECT_EQ(map.ordered_links(), 4U) << "each small square sees the side of the screen that faces it";
    EXPECT_EQ(map.hidden.size(), 2U) << "the two small squares are hidden from each other";
}

}  // namespace
}  // namespace vmap
