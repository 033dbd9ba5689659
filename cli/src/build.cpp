// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// vmap build: the visibility map of a scene, saved to be questioned and lit again.
#include "choice.h"
#include "commands.h"
#include "distinct_files.h"
#include "load_points.h"
#include "report.h"
#include "stopwatch.h"

#include <vmap/build_patch_vmap.h>
#include <vmap/build_vmap.h>
#include <vmap/error.h>
#include <vmap/octree.h>
#include <vmap/patch_tree.h>
#include <vmap/vmap_file.h>

#include <fmt/format.h>

#include <map>
#include <optional>

namespace vmap {
namespace {

struct BuildOptions {
    LoadOptions load;
    std::string output;
    VisibilityRule rule = VisibilityRule::centroid;
    VmapMethod method = VmapMethod::fast;
    OctreeKind tree = OctreeKind::adaptive;
    std::uint32_t points_per_leaf = 64;
    double cell_size = 0;
    std::size_t leaves = 0;
    std::uint32_t few_patches = 0;
    std::string report;
};

OctreeConfig octree_config(const BuildOptions& options, const PointCloud& cloud) {
    if (options.leaves > 0) return octree_config_for_leaves(cloud, options.tree, options.leaves);
    OctreeConfig config{.kind = options.tree, .cell_size = options.cell_size};
    if (options.tree == OctreeKind::adaptive && options.cell_size > 0) config.points_per_leaf = 0;
    if (options.tree == OctreeKind::adaptive && options.cell_size == 0)
        config.points_per_leaf = options.points_per_leaf;
    if (options.tree == OctreeKind::uniform && options.cell_size == 0)
        return octree_config_for_leaves(cloud, options.tree, cloud.size() / options.points_per_leaf + 1);
    return config;
}

PatchTreeConfig patch_tree_config(const BuildOptions& options, const PointCloud& cloud, const PatchSet& set) {
    if (options.leaves > 0) return patch_tree_config_for_leaves(cloud, set, options.leaves);
    if (options.cell_size > 0) return {.cell_size = options.cell_size};
    return {.points_per_leaf = options.points_per_leaf};
}

void build(const BuildOptions& options, const ProgressCallback& progress, VmapContents& contents) {
    const Stopwatch planting;
    report_progress(progress, "tree", 0);
    if (options.rule == VisibilityRule::centroid) {
        contents.tree = build_octree(contents.cloud, octree_config(options, contents.cloud));
        contents.tree_seconds = planting.seconds();
        const Stopwatch linking;
        contents.map = build_vmap(contents.tree, options.method, progress);
        contents.map_seconds = linking.seconds();
        return;
    }
    contents.patches = find_patches(contents.cloud);
    contents.tree = build_patch_tree(contents.cloud, contents.patches,
                                     patch_tree_config(options, contents.cloud, contents.patches));
    contents.tree_seconds = planting.seconds();
    const Stopwatch linking;
    contents.map = build_patch_vmap(contents.cloud, contents.tree, contents.patches,
                                    {.method = options.method, .few_patches = options.few_patches}, progress);
    contents.map_seconds = linking.seconds();
}

void run_build(const BuildOptions& options, Job& job) {
    const Stopwatch total;
    require_distinct_files({options.load.file}, {options.output, options.report});
    FileWriter file(options.output);
    std::optional<FileWriter> report_file;
    if (!options.report.empty()) report_file.emplace(options.report);

    LoadedPoints loaded = load_points(options.load, job);
    VmapContents contents;
    contents.source = loaded.info.source;
    contents.light_units = loaded.info.light_units;
    contents.cloud = std::move(loaded.cloud.points);
    contents.lights = std::move(loaded.lights);
    contents.cameras = std::move(loaded.scene.cameras);
    build(options, job.progress(), contents);
    job.tell(fmt::format("{} points, {} leaves, {} links in {:.3f} s", contents.cloud.size(),
                         contents.tree.leaves.size(), contents.map.ordered_links(), contents.map_seconds));

    const Stopwatch writing;
    write_vmap(contents, [&](std::span<const std::byte> bytes) { file.write(bytes.data(), bytes.size()); });
    file.finish();
    if (report_file) {
        const JobReport report{.input = options.load.file,
                               .points = contents.cloud.size(),
                               .lights = contents.lights.size(),
                               .area = total_area(contents.cloud),
                               .seconds = {.import = loaded.import_seconds,
                                           .sample = loaded.sample_seconds,
                                           .tree = contents.tree_seconds,
                                           .vmap = contents.map_seconds,
                                           .write = writing.seconds(),
                                           .total = total.seconds()},
                               .light = std::nullopt,
                               .map = MapCounts{contents.tree.nodes.size(), contents.tree.leaves.size(),
                                                contents.patches.patches.size(), contents.map.ordered_links()},
                               .outputs = {options.output}};
        write_report(*report_file, report, job);
        report_file->finish();
    }
    const auto hold = job.interruption().hold_off();
    file.commit();
    if (report_file) report_file->commit();
}

}  // namespace

Command add_build_command(CLI::App& program) {
    CLI::App* app = program.add_subcommand("build", "Builds the visibility map of a scene and saves it");
    app->footer("Example: vmap build room.glb -o room.vmap --rule patch");
    auto options = std::make_shared<BuildOptions>();
    add_load_options(*app, options->load);
    app->add_option("-o,--output", options->output, "The .vmap file to write")->required()->type_name("FILE");
    app->add_option("--rule", options->rule, "What a link means: centroid (the seed's test) or patch (whole shafts)")
        ->transform(choice(std::map<std::string, VisibilityRule>{{"centroid", VisibilityRule::centroid},
                                                                 {"patch", VisibilityRule::patch}}))
        ->type_name("centroid|patch")
        ->default_str("centroid");
    app->add_option("--method", options->method, "How it is built; all give the same links")
        ->transform(choice(std::map<std::string, VmapMethod>{
            {"exhaustive", VmapMethod::exhaustive}, {"seed", VmapMethod::seed}, {"fast", VmapMethod::fast}}))
        ->type_name("exhaustive|seed|fast")
        ->default_str("fast");
    app->add_option("--tree", options->tree, "Rule centroid: which octree")
        ->transform(choice(
            std::map<std::string, OctreeKind>{{"adaptive", OctreeKind::adaptive}, {"uniform", OctreeKind::uniform}}))
        ->type_name("adaptive|uniform")
        ->default_str("adaptive");
    auto* per_leaf = app->add_option("--points-per-leaf", options->points_per_leaf, "A leaf is split above so many")
                         ->check(CLI::PositiveNumber)
                         ->type_name("N")
                         ->capture_default_str();
    auto* cell = app->add_option("--cell-size", options->cell_size, "Edge of the cells instead, world units")
                     ->check(CLI::PositiveNumber)
                     ->excludes(per_leaf)
                     ->type_name("S");
    app->add_option("--leaves", options->leaves, "About so many leaves instead")
        ->check(CLI::PositiveNumber)
        ->excludes(per_leaf)
        ->excludes(cell)
        ->type_name("N");
    app->add_option("--few-patches", options->few_patches,
                    "Rule patch: no finer links where only so many patches are in the way")
        ->type_name("N")
        ->capture_default_str();
    app->add_option("--json", options->report, "Writes a report there; - is standard output")->type_name("FILE");
    return {app, [options](Job& job) { run_build(*options, job); }};
}

}  // namespace vmap
