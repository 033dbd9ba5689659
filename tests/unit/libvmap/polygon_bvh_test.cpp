// SPDX-License-Identifier: GPL-3.0-or-later
#include <vmap/polygon_bvh.h>

#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <random>

namespace vmap {
namespace {

using Imath::V3f;

/// Regular polygons of 3 to 8 vertices with random places, sizes and directions.
PolygonSet random_polygons(std::size_t count, float size, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(-1, 1);
    PolygonSet polygons;
    for (std::size_t i = 0; i < count; ++i) {
        const V3f center(uniform(random), uniform(random), uniform(random));
        const V3f normal = V3f(uniform(random), uniform(random), uniform(random) + 1e-3F).normalized();
        const V3f u = normal.cross(std::abs(normal.x) < 0.5F ? V3f(1, 0, 0) : V3f(0, 1, 0)).normalized();
        const V3f v = normal.cross(u);
        const std::size_t corners = 3 + i % 6;
        std::vector<V3f> vertices;
        for (std::size_t k = 0; k < corners; ++k) {
            const float angle = 6.2831853F * static_cast<float>(k) / static_cast<float>(corners);
            vertices.push_back(center + (u * std::cos(angle) + v * std::sin(angle)) * size);
        }
        polygons.add(vertices);
    }
    return polygons;
}

std::vector<Ray> random_rays(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(-1, 1);
    std::vector<Ray> rays(count);
    for (Ray& ray : rays) {
        ray.origin = {uniform(random), uniform(random), uniform(random)};
        ray.direction = V3f(uniform(random), uniform(random), uniform(random)).normalized();
    }
    return rays;
}

/// Distance along the ray to the polygon by double arithmetic; `margin` shrinks (positive) or grows the polygon.
std::optional<double> distance_to(const Ray& ray, std::span<const V3f> vertices, double margin) {
    const Imath::V3d origin(ray.origin);
    const Imath::V3d direction(ray.direction);
    const Imath::V3d a(vertices[0]);
    const Imath::V3d normal = (Imath::V3d(vertices[1]) - a).cross(Imath::V3d(vertices[2]) - a).normalized();
    const double t = normal.dot(a - origin) / normal.dot(direction);
    if (!(t > ray.t_min && t < ray.t_max)) return {};
    const Imath::V3d p = origin + direction * t;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const Imath::V3d from(vertices[i]);
        const Imath::V3d to(vertices[(i + 1) % vertices.size()]);
        if (normal.cross(to - from).normalized().dot(p - from) < margin) return {};
    }
    return t;
}

/// Hits of the hierarchy lie between the answers for polygons a hair smaller and a hair larger.
class PolygonBvhAgainstBruteForce : public testing::TestWithParam<std::pair<std::size_t, float>> {};

TEST_P(PolygonBvhAgainstBruteForce, FindsTheNearestPolygon) {
    const auto [count, size] = GetParam();
    const PolygonSet polygons = random_polygons(count, size, 7);
    const PolygonBvh bvh(polygons);
    const std::vector<Ray> rays = random_rays(500, 11);
    std::vector<RayHit> hits(rays.size());
    bvh.first_hits(rays, hits);
    std::size_t hit_count = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        double certain = 1e30;
        double possible = 1e30;
        for (std::size_t p = 0; p < polygons.size(); ++p) {
            certain = std::min(certain, distance_to(rays[i], polygons[p], 3e-6).value_or(1e30));
            possible = std::min(possible, distance_to(rays[i], polygons[p], -3e-6).value_or(1e30));
        }
        const double found = hits[i] ? hits[i].t : 1e30;
        // A back may hide behind a front that lies a hair farther: that is how coincident sheets are told apart.
        EXPECT_LE(found, certain * (1 + 1e-4) + 2e-4) << "ray " << i;
        EXPECT_GE(found, possible * (1 - 1e-4) - 1e-5) << "ray " << i;
        EXPECT_EQ(bvh.any_hit(rays[i]), static_cast<bool>(hits[i]));
        hit_count += hits[i] ? 1 : 0;
    }
    if (count > 0 && size >= 0.1F) {
        EXPECT_GT(hit_count, 0U);
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, PolygonBvhAgainstBruteForce,
                         testing::Values(std::pair{0U, 0.1F}, std::pair{1U, 1.0F}, std::pair{8U, 0.5F},
                                         std::pair{9U, 0.5F}, std::pair{100U, 0.2F}, std::pair{5000U, 0.05F},
                                         std::pair{20000U, 0.01F}));

TEST(PolygonBvh, TellsFrontFromBack) {
    PolygonSet polygons;
    polygons.add(std::array{V3f(0, 0, 0), V3f(1, 0, 0), V3f(1, 1, 0), V3f(0, 1, 0)});
    const PolygonBvh bvh(polygons);
    EXPECT_TRUE(bvh.first_hit({{0.5F, 0.5F, 1}, {0, 0, -1}}).front);
    const RayHit back = bvh.first_hit({{0.5F, 0.5F, -1}, {0, 0, 1}});
    ASSERT_TRUE(back);
    EXPECT_FALSE(back.front);
}

TEST(PolygonBvh, OfCoincidentOppositeSheetsTheFacingOneIsHit) {
    PolygonSet polygons;
    polygons.add(std::array{V3f(0, 0, 0), V3f(1, 0, 0), V3f(1, 1, 0), V3f(0, 1, 0)});
    polygons.add(std::array{V3f(0, 0, 0), V3f(0, 1, 0), V3f(1, 1, 0), V3f(1, 0, 0)});
    const PolygonBvh bvh(polygons);
    EXPECT_EQ(bvh.first_hit({{0.3F, 0.5F, 0.7F}, {0.1F, 0, -1}}).polygon, 0U);
    EXPECT_EQ(bvh.first_hit({{0.3F, 0.5F, -0.7F}, {0.1F, 0, 1}}).polygon, 1U);
}

TEST(PolygonBvh, SharedEdgesLeaveNoCrack) {
    PolygonSet polygons;
    constexpr int n = 20;
    const auto corner = [](int i, int k) {
        return V3f(static_cast<float>(i) / 3.0F, static_cast<float>(k) / 7.0F, 0.1F);
    };
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k)
            polygons.add(std::array{corner(i, k), corner(i + 1, k), corner(i + 1, k + 1), corner(i, k + 1)});
    const PolygonBvh bvh(polygons);
    for (int i = 1; i < n; ++i)
        for (int k = 1; k < n; ++k) {
            const V3f origin(3.1F, 1.3F, 2);
            EXPECT_TRUE(bvh.any_hit({origin, (corner(i, k) - origin) * 1.5F})) << i << ' ' << k;
        }
}

TEST(PolygonBvh, SegmentEndsAreOpen) {
    PolygonSet polygons;
    polygons.add(std::array{V3f(0, 0, 0), V3f(1, 0, 0), V3f(1, 1, 0), V3f(0, 1, 0)});
    const PolygonBvh bvh(polygons);
    EXPECT_FALSE(bvh.any_hit({{0.5F, 0.5F, 1}, {0, 0, -1}, 0, 1}));
    EXPECT_FALSE(bvh.any_hit({{0.5F, 0.5F, 0}, {0, 0, 1}, 0, 1}));
    EXPECT_TRUE(bvh.any_hit({{0.5F, 0.5F, 1}, {0, 0, -1}, 0, 1.001F}));
}

TEST(PolygonBvh, DegeneratePolygonsAreNeverHit) {
    PolygonSet polygons;
    polygons.add(std::array{V3f(0), V3f(0), V3f(0)});
    polygons.add(std::array{V3f(0), V3f(1, 0, 0), V3f(2, 0, 0)});
    const PolygonBvh bvh(polygons);
    EXPECT_FALSE(bvh.any_hit({{0.5F, 0, 1}, {0, 0, -1}}));
    EXPECT_FALSE(bvh.any_hit({{0.5F, 0, 0}, {1, 0, 0}}));
}

TEST(PolygonBvh, ShaftListHoldsEveryPolygonThatReachesIn) {
    const PolygonSet polygons = random_polygons(3000, 0.03F, 3);
    const PolygonBvh bvh(polygons);
    const std::array<HalfSpace, 4> shaft{HalfSpace{V3f(1, 0, 0), 0.2F}, HalfSpace{V3f(-1, 0, 0), 0.1F},
                                         HalfSpace{V3f(0.6F, 0.8F, 0), 0.15F}, HalfSpace{V3f(0, -1, 0), 0.3F}};
    std::vector<std::uint32_t> found;
    bvh.polygons_in(shaft, found);
    EXPECT_LT(found.size(), polygons.size() / 2);
    std::vector<bool> listed(polygons.size(), false);
    for (const std::uint32_t p : found) {
        EXPECT_FALSE(listed[p]) << "listed twice";
        listed[p] = true;
    }
    for (std::size_t p = 0; p < polygons.size(); ++p)
        for (const V3f& v : polygons[p]) {
            const bool inside = std::all_of(shaft.begin(), shaft.end(),
                                            [&](const HalfSpace& h) { return h.normal.dot(v) <= h.offset; });
            if (inside) {
                EXPECT_TRUE(listed[p]) << p;
            }
        }
}

}  // namespace
}  // namespace vmap
