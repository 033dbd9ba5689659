// SPDX-License-Identifier: GPL-3.0-or-later
// Building maps under both rules at growing numbers of leaves, and the rates of queries beside Embree on discs of the
// same points and on the source triangles. Counters of builds: leaves, ordered links, visible ordered pairs of leaves,
// processor seconds per unordered link, bytes per link. Queries run on one core.
#include "embree_peer.h"
#include "mapped_room.h"

#include <vmap/build_patch_vmap.h>
#include <vmap/build_vmap.h>
#include <vmap/octree.h>
#include <vmap/patch_tree.h>

#include <benchmark/benchmark.h>

#include <cmath>
#include <iostream>
#include <map>
#include <memory>
#include <string>

namespace vmap::bench {
namespace {

using Imath::V3d;
using Imath::V3f;

const SeedRow& row_named(const std::string& name) {
    for (const SeedRow& row : seed_rows())
        if (row.name == name) return row;
    throw std::invalid_argument(name);
}

/// Rooms are made once; a room has at least four points for each leaf.
const Room& room_for(const std::string& name, std::size_t leaves) {
    static std::map<std::pair<std::string, std::size_t>, Room> rooms;
    const auto own = static_cast<std::size_t>(std::llround(row_named(name).points * 1e6));
    const std::size_t points = std::max(own, 4 * leaves);
    const auto key = std::pair(name, points);
    if (!rooms.contains(key)) rooms.emplace(key, make_room(row_named(name), points).value());
    return rooms.at(key);
}

void count(benchmark::State& state, const Tree& tree, const VisibilityMap& map, double seconds) {
    const auto links = static_cast<double>(map.ordered_links());
    state.counters["leaves"] = static_cast<double>(tree.leaves.size());
    state.counters["links"] = links;
    state.counters["hidden"] = static_cast<double>(map.hidden.size());
    state.counters["visible_pairs"] = static_cast<double>(visible_leaf_pairs(tree, map));
    state.counters["us_per_link"] = 1e6 * seconds / static_cast<double>(state.iterations()) / (links / 2);
    const double bytes = 4 * static_cast<double>(map.partners.size()) + 8 * static_cast<double>(map.first_link.size());
    state.counters["bytes_per_link"] = bytes / (links / 2);
}

void build_octrees(benchmark::State& state, const std::string& name) {
    const auto leaves = static_cast<std::size_t>(state.range(0));
    const Room& room = room_for(name, leaves);
    const OctreeConfig config = octree_config_for_leaves(room.cloud, OctreeKind::adaptive, leaves);
    const double start = process_seconds();
    for ([[maybe_unused]] const auto& step : state) benchmark::DoNotOptimize(build_octree(room.cloud, config));
    const double each = (process_seconds() - start) / static_cast<double>(state.iterations());
    state.counters["us_per_point"] = 1e6 * each / static_cast<double>(room.cloud.size());
}

void build_centroid(benchmark::State& state, const std::string& name, VmapMethod method) {
    const auto leaves = static_cast<std::size_t>(state.range(0));
    const Room& room = room_for(name, leaves);
    const Tree tree = build_octree(room.cloud, octree_config_for_leaves(room.cloud, OctreeKind::adaptive, leaves));
    VisibilityMap map;
    const double start = process_seconds();
    for ([[maybe_unused]] const auto& step : state) map = build_vmap(tree, method);
    count(state, tree, map, process_seconds() - start);
    if (method != VmapMethod::fast && build_vmap(tree) != map) state.SkipWithError("differs from the fast method's");
}

void build_patch(benchmark::State& state, const std::string& name, VmapMethod method) {
    const auto leaves = static_cast<std::size_t>(state.range(0));
    const Room& room = room_for(name, leaves);
    PatchSet set = find_patches(room.cloud);
    const Tree tree = build_patch_tree(room.cloud, set, patch_tree_config_for_leaves(room.cloud, set, leaves));
    const PatchVmapConfig config{.method = method, .few_patches = static_cast<std::uint32_t>(state.range(1))};
    VisibilityMap map;
    const double start = process_seconds();
    for ([[maybe_unused]] const auto& step : state) map = build_patch_vmap(room.cloud, tree, set, config);
    count(state, tree, map, process_seconds() - start);
    if (method != VmapMethod::fast &&
        build_patch_vmap(room.cloud, tree, set, {.few_patches = config.few_patches}) != map)
        state.SkipWithError("differs from the fast method's");
}

/// A room with what answers questions about it.
struct Questioned {
    explicit Questioned(const std::string& name)
        : room(room_for(name, 0)),
          leaves(static_cast<std::size_t>(std::lround(std::sqrt(row_named(name).n_squared * 1e6)))),
          centroid(map_room(room.cloud, VisibilityRule::centroid, leaves, 1)),
          patch(map_room(room.cloud, VisibilityRule::patch, leaves, 1)),
          ask_centroid(room.cloud, centroid.tree, centroid.map, centroid.patches),
          ask_patch(room.cloud, patch.tree, patch.map, patch.patches),
          discs(room, EmbreePeer::Of::discs),
          triangles(room, EmbreePeer::Of::triangles),
          pairs(random_facing_pairs(room.cloud, 100'000)),
          rays(random_rays(room, 100'000)),
          lifted(lifted_points(room, 0.35)) {}

    const Room& room;
    std::size_t leaves;
    MappedRoom centroid;
    MappedRoom patch;
    VmapQuery ask_centroid;
    VmapQuery ask_patch;
    EmbreePeer discs;
    EmbreePeer triangles;
    std::vector<PointPair> pairs;
    std::vector<SampleRay> rays;
    std::vector<V3f> lifted;
};

const Questioned& questioned(const std::string& name) {
    static std::map<std::string, std::unique_ptr<Questioned>> all;
    std::unique_ptr<Questioned>& found = all[name];
    if (!found) found = std::make_unique<Questioned>(name);
    return *found;
}

template <class Sees>
void ask_pairs(benchmark::State& state, const std::string& name, const Sees& sees) {
    const Questioned& q = questioned(name);
    for ([[maybe_unused]] const auto& step : state)
        for (const PointPair& pair : q.pairs) benchmark::DoNotOptimize(sees(q, pair));
    state.counters["per_second"] =
        benchmark::Counter(static_cast<double>(q.pairs.size()), benchmark::Counter::kIsIterationInvariantRate);
}

template <class Shoot>
void ask_rays(benchmark::State& state, const std::string& name, const Shoot& shoot) {
    const Questioned& q = questioned(name);
    for ([[maybe_unused]] const auto& step : state)
        for (const SampleRay& ray : q.rays) benchmark::DoNotOptimize(shoot(q, ray));
    state.counters["per_second"] =
        benchmark::Counter(static_cast<double>(q.rays.size()), benchmark::Counter::kIsIterationInvariantRate);
}

template <class Work>
benchmark::internal::Benchmark* add(const std::string& name, const Work& work) {
    return benchmark::RegisterBenchmark(name.c_str(), work)->Unit(benchmark::kMillisecond);
}

void add_builds(const std::string& room) {
    add("tree/" + room, [=](benchmark::State& s) { build_octrees(s, room); })->Arg(1200)->UseRealTime();
    auto* centroid =
        add("centroid/" + room, [=](benchmark::State& s) { build_centroid(s, room, VmapMethod::fast); })->UseRealTime();
    auto* patch =
        add("patch/" + room, [=](benchmark::State& s) { build_patch(s, room, VmapMethod::fast); })->UseRealTime();
    for (const std::int64_t leaves : {1000, 3000, 10'000, 18'000, 30'000, 100'000}) {
        centroid->Arg(leaves);
        for (const std::int64_t few_patches : {0, 8}) patch->Args({leaves, few_patches});
    }
    // The slow methods also check that the fast one gives the same map.
    for (const auto& [name, method] :
         {std::pair("seed", VmapMethod::seed), std::pair("exhaustive", VmapMethod::exhaustive)}) {
        auto* slow_centroid = add(std::string(name) + "/centroid/" + room,
                                  [=, m = method](benchmark::State& s) { build_centroid(s, room, m); });
        auto* slow_patch = add(std::string(name) + "/patch/" + room,
                               [=, m = method](benchmark::State& s) { build_patch(s, room, m); });
        for (const std::int64_t leaves : {1000, 3000, 18'000}) {
            slow_centroid->Arg(leaves)->UseRealTime();
            slow_patch->Args({leaves, 0})->UseRealTime();
        }
    }
}

void add_queries(const std::string& room) {
    const auto pairs = [&](const std::string& who, const auto& sees) {
        add("sees/" + room + "/" + who, [=](benchmark::State& s) { ask_pairs(s, room, sees); });
    };
    pairs("patch", [](const Questioned& q, const PointPair& p) { return q.ask_patch.sees(p.x, p.y); });
    pairs("centroid", [](const Questioned& q, const PointPair& p) { return q.ask_centroid.sees(p.x, p.y); });
    pairs("embree_discs",
          [](const Questioned& q, const PointPair& p) { return q.discs.is_blocked(q.lifted[p.x], q.lifted[p.y]); });
    pairs("embree_triangles",
          [](const Questioned& q, const PointPair& p) { return q.triangles.is_blocked(q.lifted[p.x], q.lifted[p.y]); });
    const auto rays = [&](const std::string& who, const auto& shoot) {
        add("first_hit/" + room + "/" + who, [=](benchmark::State& s) { ask_rays(s, room, shoot); });
    };
    const auto ask = [](const Questioned& q, const VmapQuery& query, const SampleRay& ray) {
        return query.first_point(q.room.cloud.origin + V3d(ray.from), V3d(ray.direction));
    };
    rays("patch", [ask](const Questioned& q, const SampleRay& r) { return ask(q, q.ask_patch, r); });
    rays("centroid", [ask](const Questioned& q, const SampleRay& r) { return ask(q, q.ask_centroid, r); });
    rays("embree_discs",
         [](const Questioned& q, const SampleRay& r) { return q.discs.first_hit(r.from, r.direction); });
    rays("embree_triangles",
         [](const Questioned& q, const SampleRay& r) { return q.triangles.first_hit(r.from, r.direction); });
}

}  // namespace
}  // namespace vmap::bench

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    for (const std::string room : {"ECR", "PCR", "BUN"}) {
        if (room == "BUN" && !vmap::bench::make_room(vmap::bench::row_named(room), 1000)) continue;
        vmap::bench::add_builds(room);
        vmap::bench::add_queries(room);
    }
    benchmark::RunSpecifiedBenchmarks();
}
