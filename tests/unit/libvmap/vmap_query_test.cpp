// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud_scenes.h"
#include "patch_points.h"

#include <vmap/build_patch_vmap.h>
#include <vmap/build_vmap.h>
#include <vmap/leaf_visibility.h>
#include <vmap/octree.h>
#include <vmap/patch_tree.h>
#include <vmap/patch_visibility.h>
#include <vmap/query_vmap.h>
#include <vmap/show_visibility.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>

namespace vmap {
namespace {

using Imath::V3d;
using Imath::V3f;

/// A cloud with its tree, map and queries.
struct Questioned {
    explicit Questioned(PointCloud c, OctreeConfig config = {.points_per_leaf = 16})
        : cloud(std::move(c)), tree(build_octree(cloud, config)), map(build_vmap(tree)), query(cloud, tree, map, {}) {}

    PointCloud cloud;
    Tree tree;
    VisibilityMap map;
    VmapQuery query;
};

/// The same under rule `patch`.
struct QuestionedPatches {
    QuestionedPatches(PointCloud c, std::size_t leaves, std::uint32_t few_patches = 0)
        : cloud(with_areas(std::move(c))),
          set(find_patches(cloud)),
          tree(build_patch_tree(cloud, set, patch_tree_config_for_leaves(cloud, set, leaves))),
          map(build_patch_vmap(cloud, tree, set, {.few_patches = few_patches})),
          query(cloud, tree, map, set) {}

    static PointCloud with_areas(PointCloud cloud) {
        if (cloud.areas.empty()) cloud.areas.resize(cloud.size(), 0.01F);
        return cloud;
    }

    PointCloud cloud;
    PatchSet set;
    Tree tree;
    VisibilityMap map;
    VmapQuery query;
};

std::vector<std::uint32_t> leaf_of_each_point(const Tree& tree) {
    std::vector<std::uint32_t> leaf_of(tree.point_order.size());
    for (std::uint32_t l = 0; l < tree.leaves.size(); ++l)
        for (const std::uint32_t p : tree.points_of(tree.nodes[tree.leaves[l].node])) leaf_of[p] = l;
    return leaf_of;
}

PairStatus status_one_by_one(const VmapQuery& query, std::span<const std::uint32_t> xs,
                             std::span<const std::uint32_t> ys) {
    std::size_t seen = 0;
    for (const std::uint32_t x : xs)
        for (const std::uint32_t y : ys) seen += query.sees(x, y) ? 1 : 0;
    if (seen == 0) return PairStatus::invisible;
    return seen == xs.size() * ys.size() ? PairStatus::visible : PairStatus::partial;
}

/// Points around one of the cloud's, at least one.
std::vector<std::uint32_t> random_group(const PointCloud& cloud, const VmapQuery& query, std::mt19937& random) {
    const V3d place = cloud.origin + V3d(cloud.positions[random() % cloud.size()]);
    auto points = query.points_around(place, 0.02 * static_cast<double>(random() % 10));
    if (points.empty()) points.push_back(query.nearest_point(place));
    return points;
}

TEST(VmapQuery, PointsSeeEachOtherWhenTheirLeavesDo) {
    for (test::NamedCloud& scene : test::all_clouds(700)) {
        SCOPED_TRACE(scene.name);
        const Questioned q(std::move(scene.cloud));
        const LeafVisibility leaves(q.tree);
        const std::vector<std::uint32_t> leaf_of = leaf_of_each_point(q.tree);
        for (std::uint32_t x = 0; x < q.cloud.size(); x += 7)
            for (std::uint32_t y = 0; y < q.cloud.size(); y += 3)
                ASSERT_EQ(q.query.sees(x, y), leaves.sees(leaf_of[x], leaf_of[y])) << x << " " << y;
    }
}

TEST(VmapQuery, StatusOfGroupsIsThatOfTheirPairs) {
    std::mt19937 random(1);
    for (test::NamedCloud& scene : test::all_clouds(1500)) {
        SCOPED_TRACE(scene.name);
        const Questioned q(std::move(scene.cloud));
        for (int i = 0; i < 200; ++i) {
            const auto xs = random_group(q.cloud, q.query, random);
            const auto ys = random_group(q.cloud, q.query, random);
            ASSERT_EQ(q.query.status(xs, ys), status_one_by_one(q.query, xs, ys));
        }
    }
}

TEST(VmapQuery, StatusOfGroupsCostsNoMoreForMorePoints) {
    const auto cost_of = [](int points) {
        const Questioned q(test::packed_room(points), {.cell_size = 0.1, .points_per_leaf = 0});
        const auto xs = q.query.points_around({0.5, 0, 0.9}, 0.1);
        const auto ys = q.query.points_around({0.5, 1, 0.9}, 0.1);
        QueryCost cost;
        EXPECT_EQ(q.query.status(xs, ys, &cost), PairStatus::visible);
        return std::pair(xs.size() * ys.size(), cost.primitive_tests);
    };
    const auto [few_pairs, few_tests] = cost_of(4'000);
    const auto [many_pairs, many_tests] = cost_of(64'000);
    EXPECT_GT(many_pairs, 100 * few_pairs);
    EXPECT_LE(many_tests, few_tests);
    EXPECT_LE(many_tests, 64U);
}

TEST(VmapQuery, RaysFromTheMiddleOfARoomMeetItsWallsWhereTheyAre) {
    const Questioned q(test::empty_room(6000));
    std::mt19937 random(2);
    const auto component = [&] {
        return static_cast<double>(random()) / static_cast<double>(std::mt19937::max()) - 0.5;
    };
    for (int i = 0; i < 1000; ++i) {
        const V3d direction(component(), component(), component());
        const double to_wall = 0.5 / std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
        const auto hit = q.query.first_point({0.5, 0.5, 0.5}, direction);
        if (!hit) {
            FAIL() << "no hit";
        }
        // Discs reach over the edges of the walls: near an edge the neighbour's disc may come first.
        ASSERT_LE(hit->distance, to_wall * direction.length() * (1 + 1e-5));
        ASSERT_GE(hit->distance, to_wall * direction.length() * 0.8);
        const V3d meets = V3d(0.5) + direction * to_wall;
        ASSERT_LE((V3d(q.cloud.positions[hit->point]) - meets).length(), 0.12);
    }
}

TEST(VmapQuery, RaysAwayFromEverythingMeetNothing) {
    const Questioned q(test::packed_room(2000));
    EXPECT_FALSE(q.query.first_point({0.5, 3, 0.5}, {0, 1, 0}));
    EXPECT_FALSE(q.query.first_point({1e6, 1e6, 1e6}, {0, 1, 0}));
    EXPECT_FALSE(q.query.first_point({0.5, 3, 0.5}, {0, 0, 0}));
    const auto from_afar = q.query.first_point({0.5, 1e5, 0.95}, {0, -1, 0});
    EXPECT_NEAR(from_afar.value_or(PointHit{}).distance, 1e5 - 1, 1e-3);
}

TEST(VmapQuery, FirstHitsAreNearestOfAllDiscs) {
    const Questioned q(test::packed_room(3000));
    const LeafVisibility leaves(q.tree);
    std::mt19937 random(3);
    const auto component = [&] {
        return static_cast<float>(random()) / static_cast<float>(std::mt19937::max()) - 0.5F;
    };
    for (int i = 0; i < 500; ++i) {
        const V3f from(component(), component(), component());
        const V3f direction(component(), component(), component());
        float nearest = 1e9F;
        for (const LeafDisc& disc : leaves.discs()) {
            const LeafPlane& plane = leaves.planes()[disc.plane];
            const V3f end = from + direction * (10 / direction.length());
            const PlaneCoordinates a = to_plane(plane, from);
            const PlaneCoordinates b = to_plane(plane, end);
            if (crosses(plane, disc, a, b))
                nearest = std::min(nearest, 10 / direction.length() * a.height / (a.height - b.height));
        }
        const auto hit = leaves.first_disc(from, direction);
        ASSERT_EQ(hit.has_value(), nearest < 1e9F);
        if (hit) {
            ASSERT_NEAR(hit->t, nearest, 1e-4F * nearest);
        }
    }
}

TEST(VmapQuery, ALampLeavesItsUmbraUnderATable) {
    // The packed room's boxes are 0.6, 0.3 and 0.2 high.
    const Questioned q(test::packed_room(20'000), {.points_per_leaf = 8});
    LightSource lamp;
    lamp.position = {0.3, 0.95, 0.67};
    lamp.intensity = Imath::C3f(1);
    const auto at = [&](const V3d& place) { return q.query.light_status(q.query.nearest_point(place), lamp); };
    EXPECT_EQ(at({0.3, 0.6, 0.67}), PairStatus::visible) << "on top of the tall box";
    EXPECT_EQ(at({0.07, 0.0, 0.67}), PairStatus::invisible) << "on the floor beside it";
    EXPECT_EQ(at({0.9, 0.0, 0.9}), PairStatus::visible) << "on open floor";
    EXPECT_EQ(at({0.3, 0.3, 0.55}), PairStatus::invisible) << "on a side that faces away";
}

TEST(VmapQuery, SpotAndSunEndWhereTheyShould) {
    const Questioned q(test::empty_room(6000));
    LightSource spot;
    spot.kind = LightKind::spot;
    spot.position = {0.5, 0.9, 0.5};
    spot.direction = {0, -1, 0};
    spot.outer_cone_angle = 0.3;
    EXPECT_EQ(q.query.light_status(q.query.nearest_point({0.5, 0, 0.5}), spot), PairStatus::visible);
    EXPECT_EQ(q.query.light_status(q.query.nearest_point({0.1, 0, 0.5}), spot), PairStatus::invisible);
    LightSource sun;
    sun.kind = LightKind::sun;
    sun.direction = {0, -1, 0};
    EXPECT_EQ(q.query.light_status(q.query.nearest_point({0.5, 0, 0.5}), sun), PairStatus::invisible)
        << "the ceiling is in the way";
}

TEST(VmapQuery, NearestPointAndNeighboursAreThoseOfASearchThroughAll) {
    for (test::NamedCloud& scene : test::all_clouds(400)) {
        SCOPED_TRACE(scene.name);
        const Questioned q(std::move(scene.cloud));
        const auto distance = [&](std::uint32_t i, const V3d& place) {
            return (q.cloud.origin + V3d(q.cloud.positions[i]) - place).length();
        };
        const double size =
            std::max(1e-45, (V3d(q.tree.nodes[0].bounds.max) - V3d(q.tree.nodes[0].bounds.min)).length());
        for (std::uint32_t k = 0; k < q.cloud.size(); k += 37) {
            const V3d place = q.cloud.origin + V3d(q.cloud.positions[k]) + V3d(0.1, 0.05, -0.07) * size;
            std::vector<std::uint32_t> all(q.cloud.size());
            std::iota(all.begin(), all.end(), 0U);
            const auto nearest =
                *std::ranges::min_element(all, {}, [&](std::uint32_t i) { return distance(i, place); });
            ASSERT_DOUBLE_EQ(distance(q.query.nearest_point(place), place), distance(nearest, place));
        }
        const V3d place = q.cloud.origin + V3d(q.cloud.positions[0]);
        for (const std::uint32_t i : q.query.points_around(place, 0.3 * size))
            ASSERT_LE(distance(i, place), 0.31 * size);
        EXPECT_EQ(q.query.points_around(place, 2 * size).size(), q.cloud.size());
    }
    EXPECT_EQ(Questioned(PointCloud{}).query.nearest_point({0, 0, 0}), no_index);
}

TEST(PatchQuery, AnswersAreThoseOfTheSegmentsThemselves) {
    for (test::NamedCloud& scene : test::all_clouds(1500)) {
        SCOPED_TRACE(scene.name);
        const QuestionedPatches q(std::move(scene.cloud), 150, 2);
        const PatchVisibility visibility(q.cloud, q.tree, q.set);
        for (std::uint32_t x = 0; x < q.cloud.size(); x += 17)
            for (std::uint32_t y = 0; y < q.cloud.size(); y += 5)
                ASSERT_EQ(q.query.sees(x, y), visibility.sees(x, y)) << x << " " << y;
    }
}

TEST(PatchQuery, StatusOfGroupsHoldsForAllTheirPairs) {
    std::mt19937 random(4);
    for (test::NamedCloud& scene : test::all_clouds(1500)) {
        SCOPED_TRACE(scene.name);
        const QuestionedPatches q(std::move(scene.cloud), 150);
        for (int i = 0; i < 200; ++i) {
            const auto xs = random_group(q.cloud, q.query, random);
            const auto ys = random_group(q.cloud, q.query, random);
            const PairStatus status = q.query.status(xs, ys);
            if (status == PairStatus::partial) continue;
            ASSERT_EQ(status, status_one_by_one(q.query, xs, ys));
        }
    }
}

TEST(PatchQuery, RaysMeetTheWallsOfARoomExactly) {
    const QuestionedPatches q(test::empty_room(6000), 200);
    std::mt19937 random(2);
    const auto component = [&] {
        return static_cast<double>(random()) / static_cast<double>(std::mt19937::max()) - 0.5;
    };
    for (int i = 0; i < 2000; ++i) {
        const V3d direction(component(), component(), component());
        const double to_wall = 0.5 / std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
        const PointHit hit = q.query.first_point({0.5, 0.5, 0.5}, direction).value_or(PointHit{});
        ASSERT_NEAR(hit.distance, to_wall * direction.length(), 1e-5);
        const V3d meets = V3d(0.5) + direction * to_wall;
        const double spacing = std::sqrt(6.0 / static_cast<double>(q.cloud.size()));
        ASSERT_LE((V3d(q.cloud.positions[hit.point]) - meets).length(), 0.8 * spacing);
    }
    EXPECT_FALSE(q.query.first_point({0.5, 3, 0.5}, {0, 1, 0}));
    EXPECT_NEAR(q.query.first_point({0.3, 1e5, 0.7}, {0, -1, 0}).value_or(PointHit{}).distance, 1e5 - 1, 0.01);
}

TEST(PatchQuery, APlaceInAPatchHasTheNearestPointOfIt) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> beyond(-0.1F, 1.1F);
    for (test::NamedCloud& scene : test::all_clouds(2000)) {
        SCOPED_TRACE(scene.name);
        const PointCloud cloud = QuestionedPatches::with_areas(std::move(scene.cloud));
        const PatchSet set = find_patches(cloud);
        const PatchPoints points(cloud, set);
        for (std::uint32_t p = 0; p < set.patches.size();
             p += 1 + static_cast<std::uint32_t>(set.patches.size() / 20)) {
            const Patch& patch = set.patches[p];
            Imath::Box2f box;
            for (const std::uint32_t i : set.points_of(patch)) box.extendBy(patch.to_plane(cloud.positions[i]));
            for (int k = 0; k < 20; ++k) {
                const Imath::V2f share(beyond(random), beyond(random));
                const Imath::V2f place = box.min + box.size() * share;
                const auto distance = [&](std::uint32_t i) {
                    return (patch.to_plane(cloud.positions[i]) - place).length();
                };
                const auto nearest = *std::ranges::min_element(set.points_of(patch), {}, distance);
                ASSERT_FLOAT_EQ(distance(points.nearest(p, place)), distance(nearest));
            }
        }
    }
}

TEST(PatchQuery, ALampLeavesItsUmbraUnderATable) {
    const QuestionedPatches q(test::packed_room(20'000), 500);
    LightSource lamp;
    lamp.position = {0.3, 0.95, 0.67};
    const auto at = [&](const V3d& place) { return q.query.light_status(q.query.nearest_point(place), lamp); };
    EXPECT_EQ(at({0.3, 0.6, 0.67}), PairStatus::visible) << "on top of the tall box";
    EXPECT_EQ(at({0.07, 0.0, 0.67}), PairStatus::invisible) << "on the floor beside it";
    EXPECT_EQ(at({0.9, 0.0, 0.9}), PairStatus::visible) << "on open floor";
}

TEST(PatchQuery, ShadowsOfASurfaceAreThoseOfItsPoints) {
    const QuestionedPatches q(test::packed_room(8000), 200);
    const std::vector<std::uint32_t> lamp = q.query.points_around({0.5, 1, 0.5}, 0.15);
    ASSERT_GT(lamp.size(), 20U);
    std::array<int, 3> found{};
    for (std::uint32_t x = 0; x < q.cloud.size(); x += 13) {
        const PairStatus status = q.query.light_status(x, lamp);
        ASSERT_EQ(status, status_one_by_one(q.query, {&x, 1}, lamp)) << x;
        ++found.at(static_cast<std::size_t>(status));
    }
    EXPECT_GT(*std::ranges::min_element(found), 10) << "lit points, umbra and penumbra all occur";
}

TEST(ShowVisibility, PaintsWhatAPointSees) {
    const Questioned q(test::packed_room(4000));
    const std::uint32_t from = q.query.nearest_point({0.9, 0.9, 0});
    const std::vector<float> seen = visibility_from(q.query, q.cloud.size(), from);
    for (std::uint32_t i = 0; i < q.cloud.size(); ++i) ASSERT_EQ(seen[i] == 1, q.query.sees(from, i));
    EXPECT_GT(std::ranges::count(seen, 1.0F), 1000);
    EXPECT_LT(std::ranges::count(seen, 1.0F), 3000);
}

TEST(ShowVisibility, GroupsEmittersByMaterialAndShowsPenumbras) {
    PointCloud cloud = test::packed_room(6000);
    cloud.emission.resize(cloud.size(), Imath::C3f(0));
    cloud.materials.resize(cloud.size(), 3);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        if (cloud.positions[i].y < 0.999F || std::abs(cloud.positions[i].x - 0.5F) > 0.2F) continue;
        cloud.emission[i] = Imath::C3f(1);
        cloud.materials[i] = cloud.positions[i].x < 0.5F ? 4 : 5;
    }
    const Questioned q(std::move(cloud));
    const SceneLights lights = scene_lights(q.cloud, {});
    ASSERT_EQ(lights.surfaces.size(), 2U);
    const std::vector<float> share = umbra_picture(q.query, q.cloud.size(), lights);
    EXPECT_GT(std::ranges::count(share, 1.0F), 500);
    EXPECT_GT(std::ranges::count(share, 0.0F), 500);
    EXPECT_GT(std::ranges::count_if(share, [](float s) { return s > 0 && s < 1; }), 50);
}

}  // namespace
}  // namespace vmap
