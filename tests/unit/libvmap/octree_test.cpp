// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud_scenes.h"

#include <vmap/error.h>
#include <vmap/octree.h>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vmap {
namespace {

using Imath::V3f;

/// Octrees of both kinds, coarse and fine, that suit a cloud of any scale.
std::vector<OctreeConfig> configs_for(const PointCloud& cloud) {
    const double tenth = octree_config_for_leaves(cloud, OctreeKind::uniform, 200).cell_size;
    return {{.kind = OctreeKind::adaptive},
            {.kind = OctreeKind::adaptive, .points_per_leaf = 5},
            {.kind = OctreeKind::adaptive, .cell_size = tenth, .points_per_leaf = 0},
            {.kind = OctreeKind::uniform, .cell_size = tenth}};
}

double extent(const PointCloud& cloud) {
    Imath::Box3f box;
    for (const V3f& p : cloud.positions) box.extendBy(p);
    const Imath::V3d size = Imath::V3d(box.max) - Imath::V3d(box.min);
    return std::max({size.x, size.y, size.z});
}

void for_each_tree(int points, auto&& check) {
    for (const test::NamedCloud& scene : test::all_clouds(points))
        for (const OctreeConfig& config : configs_for(scene.cloud)) {
            SCOPED_TRACE(scene.name + (config.kind == OctreeKind::uniform ? ", uniform" : ", adaptive"));
            check(scene.cloud, config, build_octree(scene.cloud, config));
            if (testing::Test::HasFailure()) return;
        }
}

TEST(Octree, PutsEveryPointInExactlyOneLeaf) {
    for_each_tree(1500, [](const PointCloud& cloud, const OctreeConfig&, const Tree& tree) {
        std::vector<int> seen(cloud.size());
        std::uint32_t next = 0;
        for (const TreeLeaf& leaf : tree.leaves) {
            const TreeNode& node = tree.nodes[leaf.node];
            ASSERT_EQ(node.first_point, next) << "leaves are in the order of their points";
            next += node.point_count;
            for (const std::uint32_t i : tree.points_of(node)) ++seen[i];
        }
        EXPECT_EQ(std::ranges::count(seen, 1), std::ssize(cloud.positions));
    });
}

TEST(Octree, ChildrenPartTheirParent) {
    for_each_tree(1500, [](const PointCloud& cloud, const OctreeConfig&, const Tree& tree) {
        ASSERT_EQ(tree.nodes[0].point_count, cloud.size());
        std::size_t reached = 1;
        for (std::uint32_t n = 0; n < tree.nodes.size(); ++n) {
            const TreeNode& node = tree.nodes[n];
            ASSERT_EQ(node.is_leaf(), node.leaf != no_index);
            if (node.is_leaf()) {
                ASSERT_EQ(tree.leaves[node.leaf].node, n);
                continue;
            }
            ASSERT_GT(node.child_count, 1U);
            ASSERT_GT(node.first_child, n);
            reached += node.child_count;
            std::uint32_t next = node.first_point;
            for (std::uint32_t c = 0; c < node.child_count; ++c) {
                ASSERT_EQ(tree.nodes[node.first_child + c].first_point, next);
                next += tree.nodes[node.first_child + c].point_count;
            }
            ASSERT_EQ(next, node.first_point + node.point_count);
        }
        EXPECT_EQ(reached, tree.nodes.size());
    });
}

TEST(Octree, BoundsHoldPointsAndNormals) {
    for_each_tree(800, [](const PointCloud& cloud, const OctreeConfig&, const Tree& tree) {
        for (const TreeNode& node : tree.nodes)
            for (const std::uint32_t i : tree.points_of(node)) {
                ASSERT_TRUE(node.bounds.intersects(cloud.positions[i]));
                ASSERT_GE(node.cone_axis.dot(cloud.normals[i]), node.cone_cos - 1e-5F);
            }
    });
}

TEST(Octree, LeafStatisticsAreThoseOfItsPoints) {
    for_each_tree(800, [](const PointCloud& cloud, const OctreeConfig&, const Tree& tree) {
        for (const TreeLeaf& leaf : tree.leaves) {
            const auto points = tree.points_of(tree.nodes[leaf.node]);
            Imath::V3d centroid(0);
            for (const std::uint32_t i : points) centroid += Imath::V3d(cloud.positions[i]);
            centroid /= static_cast<double>(points.size());
            ASSERT_LE((V3f(centroid) - leaf.centroid).length(), 1e-6F * leaf.centroid.length());
            ASSERT_NEAR(leaf.normal.length(), 1, 1e-5);
            for (const std::uint32_t i : points) {
                const V3f d = cloud.positions[i] - leaf.centroid;
                const float rounding = 1e-6F * cloud.positions[i].length() + 1e-5F * leaf.radius + 1e-42F;
                ASSERT_LE(std::abs(leaf.normal.dot(d)), leaf.thickness + rounding);
                ASSERT_LE((d - leaf.normal * leaf.normal.dot(d)).length(), leaf.radius + rounding);
            }
        }
    });
}

TEST(Octree, LeavesKeepToTheirLimits) {
    for_each_tree(1500, [](const PointCloud& cloud, const OctreeConfig& config, const Tree& tree) {
        EXPECT_EQ(tree.cells.size(), config.kind == OctreeKind::uniform ? tree.leaves.size() : 0);
        for (const TreeLeaf& leaf : tree.leaves) {
            const TreeNode& node = tree.nodes[leaf.node];
            const V3f size = node.bounds.max - node.bounds.min;
            const double edge = std::max({size.x, size.y, size.z});
            const double rounding = 1e-6 * node.bounds.max.length();
            const bool by_count = config.kind == OctreeKind::adaptive && config.points_per_leaf > 0;
            if (!by_count) {
                ASSERT_LE(edge, config.cell_size + rounding);
            } else if (node.point_count > config.points_per_leaf) {
                ASSERT_LE(edge, 2e-6 * extent(cloud) + rounding);
            }
        }
    });
}

TEST(Octree, SameBytesForAnyNumberOfThreads) {
    const PointCloud cloud = test::packed_room(60000);
    const Tree tree = build_octree(cloud, {.points_per_leaf = 20});
    for (const std::size_t threads : {1, 2, 3, 8}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        EXPECT_EQ(build_octree(cloud, {.points_per_leaf = 20}), tree) << threads;
    }
}

TEST(Octree, SameShapeAtAnyScaleAndPlace) {
    const PointCloud cloud = test::packed_room(3000);
    const Tree tree = build_octree(cloud);
    for (const float scale : {1e-6F, 1e-3F, 1e3F, 1e6F}) {
        PointCloud scaled = cloud;
        test::transform(scaled, scale, V3f(0));
        EXPECT_EQ(build_octree(scaled).point_order, tree.point_order) << scale;
    }
}

TEST(Octree, LeavesHoldOneSurfaceEach) {
    // Points of a thin wall: the two sides and the lamp's two planes never share a leaf.
    for (const char* name : {"very thin wall", "lamp 0.001 under a ceiling", "stairs", "corner"})
        for (const test::NamedCloud& scene : test::ordinary_clouds(3000)) {
            if (scene.name != name) continue;
            SCOPED_TRACE(name);
            const Tree tree = build_octree(scene.cloud, {.points_per_leaf = 30});
            for (const TreeLeaf& leaf : tree.leaves) {
                ASSERT_LE(leaf.thickness, 1e-5F);
                for (const std::uint32_t i : tree.points_of(tree.nodes[leaf.node]))
                    ASSERT_GT(leaf.normal.dot(scene.cloud.normals[i]), 0.999F);
            }
        }
}

TEST(Octree, RadiusOfOneLeafClosedForm) {
    // 4 x 4 points on a square of edge 1: centres 1/8 from the border, spacing 1/4.
    PointCloud cloud;
    for (int i = 0; i < 16; ++i) {
        const int row = i / 4;
        cloud.positions.emplace_back((static_cast<float>(i % 4) + 0.5F) / 4, 0, (static_cast<float>(row) + 0.5F) / 4);
        cloud.normals.emplace_back(0, 1, 0);
        cloud.areas.push_back(1.0F / 16);
    }
    const Tree tree = build_octree(cloud);
    ASSERT_EQ(tree.leaves.size(), 1U);
    EXPECT_NEAR(tree.leaves[0].radius, std::sqrt(0.5), 1e-6) << "reaches the corners of the square";
    EXPECT_EQ(tree.leaves[0].centroid, V3f(0.5F, 0, 0.5F));
    EXPECT_EQ(tree.leaves[0].area, 1);

    cloud.areas.clear();
    EXPECT_NEAR(build_octree(cloud).leaves[0].radius, std::sqrt(0.5), 0.01) << "spacing from the points themselves";
}

TEST(Octree, FindsTheCellSizeForAWantedNumberOfLeaves) {
    const PointCloud cloud = test::packed_room(60000);
    for (const OctreeKind kind : {OctreeKind::adaptive, OctreeKind::uniform})
        // The range of the seed's rooms. A coarser tree of many small blocks changes in larger steps (7 % at 600
        // leaves).
        for (const std::size_t leaves : {1200, 1600, 2000}) {
            const auto found =
                static_cast<double>(build_octree(cloud, octree_config_for_leaves(cloud, kind, leaves)).leaves.size());
            EXPECT_NEAR(found / static_cast<double>(leaves), 1, 0.05);
        }
}

TEST(Octree, NothingForNoPoints) {
    EXPECT_EQ(build_octree({}), Tree{});
}

TEST(Octree, RefusesWhatIsNotFinite) {
    PointCloud cloud = test::empty_room(100);
    cloud.positions[17].y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW((void)build_octree(cloud), UnsupportedInput);
    cloud = test::empty_room(100);
    cloud.normals[3].x = std::numeric_limits<float>::infinity();
    EXPECT_THROW((void)build_octree(cloud), UnsupportedInput);
}

TEST(Octree, RefusesCellSizesWithoutMeaning) {
    const PointCloud cloud = test::empty_room(100);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double cell : {0.0, -1.0, 1e-9, nan})
        EXPECT_THROW((void)build_octree(cloud, {.kind = OctreeKind::uniform, .cell_size = cell}), UsageError) << cell;
    EXPECT_THROW((void)build_octree(cloud, {.cell_size = -1}), UsageError);
    EXPECT_THROW((void)build_octree(cloud, {.points_per_leaf = 0}), UsageError);
}

}  // namespace
}  // namespace vmap
