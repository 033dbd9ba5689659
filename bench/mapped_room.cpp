// SPDX-License-Identifier: GPL-3.0-or-later
#include "mapped_room.h"

#include <vmap/build_patch_vmap.h>
#include <vmap/build_vmap.h>
#include <vmap/octree.h>
#include <vmap/patch_tree.h>

#include <Imath/ImathBox.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <numbers>
#include <random>

namespace vmap::bench {
namespace {

using Imath::V3d;
using Imath::V3f;

constexpr double least_cosine = 1.7e-3;

/// What takes longer is measured once.
constexpr double long_seconds = 2;

/// Processor seconds of the fastest round over two cores.
template <class Do>
double best_of(int rounds, const Do& work) {
    double best = std::numeric_limits<double>::infinity();
    for (int round = 0; round < rounds && (round == 0 || best < long_seconds); ++round) {
        const double start = process_seconds();
        work();
        best = std::min(best, (process_seconds() - start) / 2);
    }
    return best;
}

double seconds_of(clockid_t clock) {
    timespec time{};
    clock_gettime(clock, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double uniform(std::mt19937_64& random) {
    return std::uniform_real_distribution<double>(0, 1)(random);
}

}  // namespace

MappedRoom map_room(const PointCloud& cloud, VisibilityRule rule, std::size_t leaves, int rounds,
                    std::uint32_t few_patches) {
    MappedRoom mapped;
    if (rule == VisibilityRule::centroid) {
        const OctreeConfig config = octree_config_for_leaves(cloud, OctreeKind::adaptive, leaves);
        mapped.tree_seconds = best_of(rounds, [&] { mapped.tree = build_octree(cloud, config); });
        mapped.map_seconds = best_of(rounds, [&] { mapped.map = build_vmap(mapped.tree); });
        return mapped;
    }
    mapped.patch_seconds = best_of(rounds > 1 ? 2 : 1, [&] { mapped.patches = find_patches(cloud); });
    // The cells of the octree: curved groups are leaves of their own, however many there are.
    const PatchTreeConfig config{.cell_size = octree_config_for_leaves(cloud, OctreeKind::adaptive, leaves).cell_size};
    const PatchSet found = mapped.patches;
    mapped.tree_seconds = best_of(rounds, [&] {
        mapped.patches = found;
        mapped.tree = build_patch_tree(cloud, mapped.patches, config);
    });
    mapped.map_seconds = best_of(rounds, [&] {
        mapped.map = build_patch_vmap(cloud, mapped.tree, mapped.patches, {.few_patches = few_patches});
    });
    return mapped;
}

std::vector<PointPair> random_facing_pairs(const PointCloud& cloud, std::size_t count) {
    std::mt19937_64 random(1);
    std::uniform_int_distribution<std::uint32_t> any(0, static_cast<std::uint32_t>(cloud.size() - 1));
    std::vector<PointPair> pairs;
    while (pairs.size() < count) {
        const PointPair pair{any(random), any(random)};
        const V3d way = V3d(cloud.positions[pair.y]) - V3d(cloud.positions[pair.x]);
        const double least = least_cosine * way.length();
        if (V3d(cloud.normals[pair.x]).dot(way) > least && -V3d(cloud.normals[pair.y]).dot(way) > least)
            pairs.push_back(pair);
    }
    return pairs;
}

std::vector<V3f> lifted_points(const Room& room, double spacings) {
    const auto lift = static_cast<float>(spacings * room.spacing());
    std::vector<V3f> lifted(room.cloud.size());
    for (std::size_t i = 0; i < lifted.size(); ++i) lifted[i] = room.cloud.positions[i] + room.cloud.normals[i] * lift;
    return lifted;
}

std::vector<SampleRay> random_rays(const Room& room, std::size_t count) {
    Imath::Box3f box;
    for (const V3f& p : room.cloud.positions) box.extendBy(p);
    std::mt19937_64 random(2);
    std::vector<SampleRay> rays;
    for (std::size_t i = 0; i < count; ++i) {
        const double x = uniform(random);
        const double y = uniform(random);
        const double z = 2 * uniform(random) - 1;
        const double angle = 2 * std::numbers::pi * uniform(random);
        const double r = std::sqrt(1 - z * z);
        const V3f share(V3d(x, y, uniform(random)));
        rays.push_back({box.min + box.size() * share, V3f(V3d(r * std::cos(angle), r * std::sin(angle), z))});
    }
    return rays;
}

double thread_seconds() {
    return seconds_of(CLOCK_THREAD_CPUTIME_ID);
}

double process_seconds() {
    return seconds_of(CLOCK_PROCESS_CPUTIME_ID);
}

}  // namespace vmap::bench
