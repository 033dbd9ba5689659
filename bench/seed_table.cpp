// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The seed's table with this project's rows below the seed's, as Markdown: counts and seconds, rates of queries beside
/// Embree, wrong answers against the source meshes. Arguments: names of rooms; none for all seven.
#include "embree_peer.h"
#include "mapped_room.h"
#include "mesh_truth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <functional>
#include <iterator>

namespace vmap::bench {
namespace {

using Imath::V3d;
using Imath::V3f;

constexpr int build_rounds = 3;
constexpr int query_rounds = 3;
constexpr std::size_t query_count = 100'000;
constexpr std::size_t truth_count = 100'000;

struct Tables {
    std::string counts;
    std::string rates;
    std::string hits;
    std::string errors;
};

template <class... Values>
void line(std::string& table, fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(table), format, std::forward<Values>(values)...);
    table += '\n';
}

void add_counts(std::string& table, const SeedRow& row, const Room& room, const MappedRoom& mapped, const char* rule) {
    const double n_squared = std::pow(static_cast<double>(mapped.tree.leaves.size()), 2);
    const auto links = static_cast<double>(mapped.map.ordered_links());
    const auto visible = static_cast<double>(visible_leaf_pairs(mapped.tree, mapped.map));
    const double build = mapped.patch_seconds + mapped.tree_seconds + mapped.map_seconds;
    line(table,
         "| {} `{}` | {:.2f} | {} | {:.2f} | {:.3f} | {:.1f} | {:.1f} | {:.2f} | {:.2f} | {:.3f} | {:.3f} | {:.0f} |",
         row.name, rule, static_cast<double>(room.cloud.size()) / 1e6, mapped.tree.leaves.size(), n_squared / 1e6,
         links / 1e6, 100 * (1 - links / n_squared), 100 * (1 - links / visible), 4 * n_squared / 1048576,
         4 * links / 1048576, mapped.patch_seconds + mapped.tree_seconds, mapped.map_seconds, row.seconds / build);
}

/// Queries per processor second on one core, the best of several rounds.
double rate_of(std::size_t count, const std::function<void()>& ask_all) {
    double best = 0;
    for (int round = 0; round < query_rounds; ++round) {
        const double start = thread_seconds();
        ask_all();
        best = std::max(best, static_cast<double>(count) / (thread_seconds() - start));
    }
    return best;
}

void add_rates(Tables& tables, const SeedRow& row, const Room& room, const VmapQuery& patch, const VmapQuery& centroid,
               const EmbreePeer& discs, const EmbreePeer& triangles) {
    const std::vector<PointPair> pairs = random_facing_pairs(room.cloud, query_count);
    const std::vector<V3f> lifted = lifted_points(room, 0.35);
    std::size_t seen = 0;  // keeps the compiler from leaving the questions out
    const auto of_pairs = [&](const auto& sees) {
        return rate_of(pairs.size(), [&] {
            for (const PointPair& pair : pairs) seen += sees(pair) ? 1 : 0;
        });
    };
    const double patch_rate = of_pairs([&](const PointPair& p) { return patch.sees(p.x, p.y); });
    const double disc_rate = of_pairs([&](const PointPair& p) { return !discs.is_blocked(lifted[p.x], lifted[p.y]); });
    const double triangle_rate =
        of_pairs([&](const PointPair& p) { return !triangles.is_blocked(lifted[p.x], lifted[p.y]); });
    const double centroid_rate = of_pairs([&](const PointPair& p) { return centroid.sees(p.x, p.y); });
    line(tables.rates, "| {} | {:.1f} | {:.1f} | {:.2f} | {:.2f} | {:.1f} | {:.1f} |{}", row.name, patch_rate / 1e6,
         centroid_rate / 1e6, disc_rate / 1e6, triangle_rate / 1e6, patch_rate / disc_rate, patch_rate / triangle_rate,
         seen == 0 ? " nothing seen" : "");

    const std::vector<SampleRay> rays = random_rays(room, query_count);
    const auto of_rays = [&](const auto& shoot) {
        return rate_of(rays.size(), [&] {
            for (const SampleRay& ray : rays) seen += std::isfinite(shoot(ray)) ? 1 : 0;
        });
    };
    const auto ask = [&](const VmapQuery& query, const SampleRay& ray) {
        const auto hit = query.first_point(room.cloud.origin + V3d(ray.from), V3d(ray.direction));
        return hit ? hit->distance : std::numeric_limits<double>::infinity();
    };
    const double first_patch = of_rays([&](const SampleRay& ray) { return ask(patch, ray); });
    const double first_disc = of_rays([&](const SampleRay& ray) { return discs.first_hit(ray.from, ray.direction); });
    const double first_triangle =
        of_rays([&](const SampleRay& ray) { return triangles.first_hit(ray.from, ray.direction); });
    const double first_centroid = of_rays([&](const SampleRay& ray) { return ask(centroid, ray); });
    std::size_t same = 0;
    for (const SampleRay& ray : rays) {
        const double ours = ask(patch, ray);
        const auto mesh = static_cast<double>(triangles.first_hit(ray.from, ray.direction));
        same += ours == mesh || std::abs(ours - mesh) <= room.spacing() ? 1 : 0;
    }
    line(tables.hits, "| {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.1f} | {:.2f} | {:.2f} |", row.name,
         first_patch / 1e6, first_centroid / 1e6, first_disc / 1e6, first_triangle / 1e6, first_patch / first_disc,
         first_patch / first_triangle, 100 * static_cast<double>(same) / static_cast<double>(rays.size()));
}

void add_errors(std::string& table, const SeedRow& row, const Room& room, const MappedRoom& patch_map,
                const VmapQuery& patch, const MappedRoom& centroid_map, const VmapQuery& centroid,
                const EmbreePeer& discs) {
    const MeshTruth truth(room, random_facing_pairs(room.cloud, truth_count));
    const std::vector<V3f> lifted = lifted_points(room, 0.35);
    const auto by_patch = truth.wrong([&](const PointPair& p) { return patch.sees(p.x, p.y); });
    const auto by_centroid = truth.wrong([&](const PointPair& p) { return centroid.sees(p.x, p.y); });
    const auto by_discs = truth.wrong([&](const PointPair& p) { return !discs.is_blocked(lifted[p.x], lifted[p.y]); });
    line(table, "| {} | {:.1f} | {:.3f} | {:.3f} | {:.2f} | {:.2f} | {:.3f} | {:.3f} | {:.3f} | {:.2f} |", row.name,
         100 * truth.share_near_silhouettes(), 100 * by_patch.all, 100 * by_patch.away, 100 * by_centroid.all,
         100 * by_centroid.away, 100 * by_discs.all, 100 * by_discs.away,
         100 * broken_links(truth, patch_map, truth_count), 100 * broken_links(truth, centroid_map, truth_count));
}

void add_room(Tables& tables, const SeedRow& row) {
    const std::optional<Room> room = make_room(row);
    if (!room) return;
    const auto leaves = static_cast<std::size_t>(std::lround(std::sqrt(row.n_squared * 1e6)));
    const MappedRoom centroid = map_room(room->cloud, VisibilityRule::centroid, leaves, build_rounds);
    const MappedRoom patch = map_room(room->cloud, VisibilityRule::patch, leaves, build_rounds);
    line(tables.counts, "| **{}** seed | {:.2f} | | {:.2f} | {:.2f} | {:.1f} | | {:.2f} | {:.2f} | | {:.1f} | 1 |",
         row.name, row.points, row.n_squared, row.links, row.decrease, row.n_squared_mb, row.vmap_mb, row.seconds);
    add_counts(tables.counts, row, *room, centroid, "centroid");
    add_counts(tables.counts, row, *room, patch, "patch");

    const VmapQuery ask_centroid(room->cloud, centroid.tree, centroid.map, centroid.patches);
    const VmapQuery ask_patch(room->cloud, patch.tree, patch.map, patch.patches);
    const EmbreePeer discs(*room, EmbreePeer::Of::discs);
    const EmbreePeer triangles(*room, EmbreePeer::Of::triangles);
    add_rates(tables, row, *room, ask_patch, ask_centroid, discs, triangles);
    add_errors(tables.errors, row, *room, patch, ask_patch, centroid, ask_centroid, discs);
}

/// - names: of the rooms; all when there are none
void print_tables(const std::vector<std::string>& names) {
    Tables tables;
    for (const SeedRow& row : seed_rows()) {
        if (!names.empty() && std::ranges::find(names, row.name) == names.end()) continue;
        fmt::print(stderr, "{}: {}\n", row.name, row.what);
        add_room(tables, row);
    }
    fmt::print(
        "| room | points 10^6 | leaves | N^2 10^6 | links 10^6 | decrease % | against visible pairs % | N^2 MiB | "
        "V-map "
        "MiB | tree s | map s | seed's seconds over ours |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|\n{}\n",
        tables.counts);
    fmt::print(
        "| room | `patch` 10^6/s | `centroid` | Embree discs | Embree triangles | `patch` over discs | over triangles "
        "|\n|---|---|---|---|---|---|---|\n{}\n",
        tables.rates);
    fmt::print(
        "| room | `patch` 10^6/s | `centroid` | Embree discs | Embree triangles | `patch` over discs | over triangles "
        "| "
        "same hit % |\n|---|---|---|---|---|---|---|---|\n{}\n",
        tables.hits);
    fmt::print(
        "| room | near silhouettes % | `patch` all % | `patch` away % | `centroid` all % | `centroid` away % | discs "
        "all "
        "% | discs away % | `patch` links broken % | `centroid` links broken % "
        "|\n|---|---|---|---|---|---|---|---|---|---|\n{}\n",
        tables.errors);
}

}  // namespace
}  // namespace vmap::bench

int main(int argc, char** argv) try {
    vmap::bench::print_tables({argv + 1, argv + argc});
} catch (const std::exception& error) {
    std::fputs(error.what(), stderr);
    return 1;
}
