// SPDX-License-Identifier: GPL-3.0-or-later
#include <vmap/importers/sample_surface.h>

#include "blue_noise.h"
#include "finish_points.h"
#include "lit_surface.h"
#include "share_out.h"
#include "stratified.h"

#include <vmap/error.h>
#include <vmap/surface_shading.h>

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace vmap {
namespace {

void check(const SampleConfig& config) {
    if (config.points && config.spacing)
        throw UsageError("number of points and spacing are both given, expected one of them");
    if (config.points && *config.points == 0) throw UsageError("0 points asked for, expected 1 or more");
    if (config.points && *config.points > std::numeric_limits<std::uint32_t>::max())
        throw UsageError(std::to_string(*config.points) + " points asked for, expected fewer than 2^32");
    if (config.spacing && !(*config.spacing > 0 && std::isfinite(*config.spacing)))
        throw UsageError("spacing is " + fmt::format("{:g}", *config.spacing) + ", expected more than 0");
}

double area_of(const LitSurface& surface) {
    double area = 0;
    for (const LitTriangle& triangle : surface.triangles) area += triangle.area;
    return area;
}

std::size_t number_of_points(const SampleConfig& config, double area) {
    if (!config.spacing) return config.points.value_or(SampleConfig::default_points);
    const double count = std::round(area / (*config.spacing * *config.spacing));
    if (!(count <= std::numeric_limits<std::uint32_t>::max()))
        throw UsageError("spacing " + fmt::format("{:g}", *config.spacing) + " asks for " + fmt::format("{:g}", count) +
                         " points, expected fewer than 2^32");
    return std::max<std::size_t>(static_cast<std::size_t>(count), 1);
}

/// Points for each surface, indexed by LitTriangle::surface: in proportion to the areas, at least one each.
std::vector<std::size_t> counts_of_surfaces(const LitSurface& surface, std::size_t total) {
    std::vector<double> areas(2 * surface.scene->materials.size(), 0);
    for (const LitTriangle& triangle : surface.triangles) areas[triangle.surface] += triangle.area;
    std::vector<double> present;
    for (const double area : areas)
        if (area > 0) present.push_back(area);
    const std::vector<std::size_t> shares = share_out_nearest(present, total);
    std::vector<std::size_t> counts(areas.size(), 0);
    for (std::size_t s = 0, k = 0; s < areas.size(); ++s)
        if (areas[s] > 0) counts[s] = shares[k++];
    return counts;
}

/// Points are written as floats: what they cannot hold is refused.
void check_size(const LitSurface& surface, double area, std::size_t count) {
    constexpr double smallest = 1e-36;
    constexpr double largest = 1e36;
    const double share = area / static_cast<double>(count);
    if (share > smallest && share < largest && surface.extent < largest) return;
    throw UnsupportedInput(fmt::format("{}: a point's share of the surface is {:g} square units, expected {:g} to {:g}",
                                       surface.scene->source, share, smallest, largest));
}

[[noreturn]] void refuse_empty(const Scene& scene) {
    throw UnsupportedInput(scene.source + ": has no surface with an area, expected triangles to put points on");
}

}  // namespace

PointCloud sample_surface(const Scene& scene, const SampleConfig& config, const ProgressCallback& progress,
                          SampleReport* report) {
    check(config);
    report_progress(progress, "sample", 0);
    LitSurface surface = find_lit_surface(scene, config.sides);
    if (surface.triangles.empty()) refuse_empty(scene);
    const SurfaceShading shading(scene);
    const double rough_spacing =
        config.spacing.value_or(std::sqrt(area_of(surface) / static_cast<double>(number_of_points(config, 1))));
    cut_masked_areas(surface, shading, rough_spacing, config.seed);
    if (surface.triangles.empty()) refuse_empty(scene);

    SampleReport found;
    found.area = area_of(surface);
    const std::size_t count = number_of_points(config, found.area);
    check_size(surface, found.area, count);
    found.spacing = std::sqrt(found.area / static_cast<double>(count));
    found.degenerate_faces = surface.degenerate_faces;
    if (found.degenerate_faces > 0)
        found.warnings.push_back(std::to_string(found.degenerate_faces) + " triangles have no area and are left out");

    const std::vector<std::size_t> counts = counts_of_surfaces(surface, count);
    report_progress(progress, "sample", 0.1);
    Placement placement = config.pattern == SamplePattern::blue_noise
                              ? place_blue_noise(surface, shading, counts, found.spacing, config.seed, progress)
                              : place_stratified(surface, shading, counts, config.seed);
    PointCloud cloud =
        finish_points(surface, shading, std::move(placement), found.spacing, config.normals, progress, found.warnings);
    report_progress(progress, "sample", 1);
    if (report != nullptr) *report = std::move(found);
    return cloud;
}

}  // namespace vmap
