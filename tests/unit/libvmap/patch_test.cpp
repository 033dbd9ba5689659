// SPDX-License-Identifier: GPL-3.0-or-later
#include <vmap/outline.h>
#include <vmap/patch.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace vmap {
namespace {

using Imath::V3f;

/// Adds jittered points of a parallelogram corner + [0,1] a + [0,1] b, facing a x b.
void add_wall(PointCloud& cloud, const V3f& corner, const V3f& a, const V3f& b, int n, std::mt19937& random) {
    std::uniform_real_distribution<float> uniform(0, 1);
    const V3f cross = a.cross(b);
    const auto cells = static_cast<float>(n);
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            const float x = (static_cast<float>(i) + uniform(random)) / cells;
            const float y = (static_cast<float>(k) + uniform(random)) / cells;
            cloud.positions.push_back(corner + a * x + b * y);
            cloud.normals.push_back(cross.normalized());
            cloud.areas.push_back(cross.length() / (cells * cells));
            cloud.albedo.emplace_back(0.5F, 0.5F, 0.5F);
        }
}

PointCloud closed_box(int n) {
    std::mt19937 random(5);
    PointCloud cloud;
    const V3f o(0);
    const V3f x(1, 0, 0);
    const V3f y(0, 1, 0);
    const V3f z(0, 0, 1);
    add_wall(cloud, o, x, y, n, random);
    add_wall(cloud, z, y, x, n, random);
    add_wall(cloud, o, y, z, n, random);
    add_wall(cloud, x, z, y, n, random);
    add_wall(cloud, o, z, x, n, random);
    add_wall(cloud, y, x, z, n, random);
    return cloud;
}

double outline_area(const PatchSet& set, std::size_t patch) {
    std::vector<Imath::V2d> flat;
    for (const V3f& v : set.outlines[patch]) flat.emplace_back(set.patches[patch].to_plane(v));
    return polygon_area(flat);
}

TEST(FindPatches, ClosedBoxIsSixExactSquares) {
    for (const int n : {20, 64}) {
        const PatchSet set = find_patches(closed_box(n));
        ASSERT_EQ(set.patches.size(), 6U) << n;
        for (std::size_t p = 0; p < 6; ++p) {
            EXPECT_TRUE(set.patches[p].flat);
            EXPECT_EQ(set.outlines[p].size(), 4U);
            EXPECT_NEAR(outline_area(set, p), 1.0, 1e-4);
            for (const V3f& v : set.outlines[p])
                for (int axis = 0; axis < 3; ++axis)
                    EXPECT_NEAR(std::min(std::abs(v[axis]), std::abs(1 - v[axis])), 0, 1e-4);
        }
    }
}

TEST(FindPatches, EveryPointIsInExactlyOnePatch) {
    const PointCloud cloud = closed_box(30);
    const PatchSet set = find_patches(cloud);
    std::vector<std::uint32_t> order = set.point_order;
    std::sort(order.begin(), order.end());
    ASSERT_EQ(order.size(), cloud.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) EXPECT_EQ(order[i], i);
    std::size_t total = 0;
    for (const Patch& patch : set.patches) total += patch.point_count;
    EXPECT_EQ(total, cloud.size());
}

TEST(FindPatches, WallWithADoorIsCutIntoConvexPieces) {
    std::mt19937 random(3);
    PointCloud cloud;
    add_wall(cloud, V3f(0), V3f(4, 0, 0), V3f(0, 3, 0), 120, random);
    PointCloud holed;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const V3f& p = cloud.positions[i];
        if (p.x > 1 && p.x < 2 && p.y < 2) continue;
        holed.positions.push_back(p);
        holed.normals.push_back(cloud.normals[i]);
        holed.areas.push_back(cloud.areas[i]);
        holed.albedo.push_back(cloud.albedo[i]);
    }
    const PatchSet set = find_patches(holed);
    EXPECT_LE(set.patches.size(), 5U);
    double area = 0;
    for (std::size_t p = 0; p < set.patches.size(); ++p) area += outline_area(set, p);
    EXPECT_NEAR(area, 10.0, 0.05);
}

TEST(FindPatches, NoPatchHasBothSidesOfARoomsPartitionInIt) {
    PointCloud cloud = closed_box(40);
    std::mt19937 random(6);
    // A sheet with two sides at x = 0.3 from wall to wall, floor to ceiling: it parts four sides of the box.
    add_wall(cloud, V3f(0.3F, 0, 0), V3f(0, 1, 0), V3f(0, 0, 1), 40, random);
    add_wall(cloud, V3f(0.3F, 0, 0), V3f(0, 0, 1), V3f(0, 1, 0), 40, random);
    const PatchSet set = find_patches(cloud);
    EXPECT_EQ(set.patches.size(), 12U);
    for (const Patch& patch : set.patches) {
        const auto beyond = [&](std::uint32_t i) { return cloud.positions[i].x > 0.3F + 1e-5F; };
        const auto before = [&](std::uint32_t i) { return cloud.positions[i].x < 0.3F - 1e-5F; };
        const std::span<const std::uint32_t> points = set.points_of(patch);
        EXPECT_FALSE(std::any_of(points.begin(), points.end(), beyond) &&
                     std::any_of(points.begin(), points.end(), before));
    }
}

TEST(FindPatches, EachSideOfASheetIsOneFlatPatch) {
    for (const float thickness : {0.0F, 1e-4F}) {
        std::mt19937 random(5);
        PointCloud cloud;
        add_wall(cloud, V3f(0, 0, thickness), V3f(1, 0, 0), V3f(0, 1, 0), 40, random);
        add_wall(cloud, V3f(0), V3f(0, 1, 0), V3f(1, 0, 0), 40, random);
        const PatchSet set = find_patches(cloud);
        ASSERT_EQ(set.patches.size(), 2U) << "thickness " << thickness;
        for (std::size_t p = 0; p < 2; ++p) {
            EXPECT_TRUE(set.patches[p].flat);
            EXPECT_NEAR(outline_area(set, p), 1, 1e-3);
        }
        EXPECT_NEAR(set.patches[0].normal.dot(set.patches[1].normal), -1, 1e-5);
    }
}

TEST(FindPatches, SphereFallsIntoSmallGroupsOfBoundedNormals) {
    PointCloud cloud;
    constexpr int n = 5000;
    for (int i = 0; i < n; ++i) {
        const float z = 1 - 2 * (static_cast<float>(i) + 0.5F) / n;
        const float angle = 2.39996323F * static_cast<float>(i);
        const float r = std::sqrt(1 - z * z);
        const V3f p(r * std::cos(angle), r * std::sin(angle), z);
        cloud.positions.push_back(p);
        cloud.normals.push_back(p);
        cloud.areas.push_back(12.566F / n);
        cloud.albedo.emplace_back(0.5F, 0.5F, 0.5F);
    }
    const PatchSet set = find_patches(cloud);
    EXPECT_GT(set.patches.size(), n / 33U);
    for (const Patch& patch : set.patches) {
        EXPECT_FALSE(patch.flat);
        for (const std::uint32_t i : set.points_of(patch)) EXPECT_GT(cloud.normals[i].dot(patch.normal), 0.85F);
    }
}

TEST(FindPatches, DegenerateCloudsAreAnswered) {
    EXPECT_TRUE(find_patches({}).patches.empty());
    for (const std::size_t count : {1U, 2U, 100U}) {
        PointCloud cloud;
        cloud.positions.assign(count, V3f(1, 2, 3));
        cloud.normals.assign(count, V3f(0, 1, 0));
        cloud.areas.assign(count, 0.5F);
        cloud.albedo.assign(count, Imath::C3f(0.5F));
        const PatchSet same = find_patches(cloud);
        EXPECT_EQ(same.point_order.size(), count);
        for (std::size_t i = 0; i < count; ++i) cloud.positions[i].x = static_cast<float>(i);
        const PatchSet line = find_patches(cloud);
        EXPECT_EQ(line.point_order.size(), count);
    }
}

}  // namespace
}  // namespace vmap
