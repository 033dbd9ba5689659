// SPDX-License-Identifier: GPL-3.0-or-later
#include "pencil_tracer.h"

#include <vmap/polygon_bvh.h>

#include <gtest/gtest.h>

#include <random>

namespace vmap {
namespace {

using Imath::V3f;

/// Rectangles of very different sizes, so that some are tried one by one and the others lie in the hierarchy.
PolygonSet mixed_rectangles(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(-1, 1);
    PolygonSet polygons;
    for (std::size_t i = 0; i < count; ++i) {
        const V3f center(uniform(random), uniform(random), uniform(random));
        const NormalFrame frame(V3f(uniform(random), uniform(random), uniform(random) + 1e-3F).normalized());
        const float size = i % 7 == 0 ? 0.5F : 0.05F;
        polygons.add(std::vector<V3f>{center - (frame.x + frame.y) * size, center + (frame.x - frame.y) * size,
                                      center + (frame.x + frame.y) * size, center - (frame.x - frame.y) * size});
    }
    return polygons;
}

class PencilTracerAgainstHierarchy : public testing::TestWithParam<std::size_t> {};

TEST_P(PencilTracerAgainstHierarchy, FindsTheSameFirstHits) {
    const PolygonSet polygons = mixed_rectangles(GetParam(), 3);
    const std::vector<float> dilation(polygons.size(), 0.0F);
    const PolygonBvh bvh(polygons, {dilation});
    const PencilTracer pencils(polygons, dilation);
    const GatherDirections directions(64, 1);

    std::mt19937 random(5);
    std::uniform_real_distribution<float> uniform(-1, 1);
    std::size_t different = 0;
    constexpr std::size_t origins = 300;
    for (std::uint32_t i = 0; i < origins; ++i) {
        const V3f origin(uniform(random), uniform(random), uniform(random));
        const NormalFrame frame(V3f(uniform(random), uniform(random), uniform(random)).normalized());
        const DirectionSet set = directions.set(i);
        std::vector<RayHit> hits(set.size());
        pencils.first_hits(origin, frame, set, hits);
        for (std::size_t k = 0; k < hits.size(); ++k) {
            const RayHit expected = bvh.first_hit({origin, frame.world_from_local(set[k])});
            if (hits[k].polygon != expected.polygon) {
                ++different;  // a ray through an edge, where rounding decides
                continue;
            }
            if (!expected) continue;
            const std::span<const V3f> met = polygons[expected.polygon];
            const V3f normal = (met[1] - met[0]).cross(met[2] - met[0]).normalized();
            const float slope = std::abs(normal.dot(frame.world_from_local(set[k])));
            EXPECT_NEAR(hits[k].t, expected.t, 4e-6F / slope);
            EXPECT_EQ(hits[k].front, expected.front);
        }
    }
    EXPECT_LE(different, origins * 64 / 5000);
}
INSTANTIATE_TEST_SUITE_P(Counts, PencilTracerAgainstHierarchy, testing::Values(1, 5, 48, 49, 700));

TEST(PencilTracer, OfTwoSheetsInOnePlaceTheOneThatFacesTheRayIsHit) {
    PolygonSet polygons;
    const std::vector<V3f> down{{-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 2}};
    polygons.add(std::vector<V3f>(down.rbegin(), down.rend()));
    polygons.add(down);
    const std::vector<float> dilation(2, 0.0F);
    const PencilTracer pencils(polygons, dilation);
    const GatherDirections directions(64, 1);
    std::vector<RayHit> hits(64);
    pencils.first_hits({0, 0, 0}, NormalFrame({0, 0, 1}), directions.set(0), hits);
    for (const RayHit& hit : hits) {
        if (!hit) continue;
        EXPECT_EQ(hit.polygon, 1U);
        EXPECT_TRUE(hit.front);
    }
}

TEST(PencilTracer, NothingIsHitInAnEmptySet) {
    const PencilTracer pencils;
    const GatherDirections directions(8, 1);
    std::vector<RayHit> hits(8);
    pencils.first_hits({0, 0, 0}, NormalFrame({0, 0, 1}), directions.set(0), hits);
    for (const RayHit& hit : hits) EXPECT_FALSE(hit);
}

}  // namespace
}  // namespace vmap
