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

/// Fewer points than that make a lamp of flat facets that shows in its light,
constexpr std::size_t least_lamp_points = 1000;
/// but more than that share of all points are not spent on it.
constexpr double most_lamp_share = 0.05;

/// Points for the surfaces that emit: in proportion to their area, or more where that is too few for their shape.
std::size_t number_of_lamp_points(double lamp_area, double area, std::size_t total) {
    const double even = std::round(lamp_area / area * static_cast<double>(total));
    const double wanted = std::min<double>(least_lamp_points, most_lamp_share * static_cast<double>(total));
    return static_cast<std::size_t>(std::max(even, std::floor(wanted)));
}

/// The triangles of materials that emit, taken out of a surface that has others too; none when lamps have enough
/// points.
LitSurface take_lamps(LitSurface& surface, std::size_t total) {
    const auto emits = [&](const LitTriangle& triangle) {
        return surface.scene->materials[triangle.material()].emits();
    };
    LitSurface lamps = surface;
    std::erase_if(lamps.triangles, [&](const LitTriangle& triangle) { return !emits(triangle); });
    const double lamp_area = area_of(lamps);
    const double area = area_of(surface);
    const std::size_t count = number_of_lamp_points(lamp_area, area, total);
    const bool dense_enough = static_cast<double>(count) < 1.5 * lamp_area / area * static_cast<double>(total);
    if (lamps.triangles.empty() || lamps.triangles.size() == surface.triangles.size() || dense_enough)
        lamps.triangles.clear();
    else
        std::erase_if(surface.triangles, emits);
    return lamps;
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

PointCloud sample_part(const LitSurface& surface, const SurfaceShading& shading, std::size_t count,
                       const SampleConfig& config, const ProgressCallback& progress,
                       std::vector<std::string>& warnings) {
    const double spacing = std::sqrt(area_of(surface) / static_cast<double>(count));
    const std::vector<std::size_t> counts = counts_of_surfaces(surface, count);
    Placement placement = config.pattern == SamplePattern::blue_noise
                              ? place_blue_noise(surface, shading, counts, spacing, config.seed, progress)
                              : place_stratified(surface, shading, counts, config.seed);
    return finish_points(surface, shading, std::move(placement), spacing, config.normals, progress, warnings);
}

/// Appends points of the same scene.
void append(PointCloud& cloud, const PointCloud& more) {
    const auto join = [](auto& all, const auto& part) { all.insert(all.end(), part.begin(), part.end()); };
    if (more.emits()) cloud.emission.resize(cloud.size(), Imath::C3f(0, 0, 0));
    join(cloud.positions, more.positions);
    join(cloud.normals, more.normals);
    join(cloud.areas, more.areas);
    join(cloud.albedo, more.albedo);
    join(cloud.emission, more.emission);
    join(cloud.faces, more.faces);
    join(cloud.materials, more.materials);
    if (cloud.emits()) cloud.emission.resize(cloud.size(), Imath::C3f(0, 0, 0));
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

    report_progress(progress, "sample", 0.1);
    const LitSurface lamps = take_lamps(surface, count);
    const std::size_t lamp_count =
        lamps.triangles.empty() ? 0 : number_of_lamp_points(area_of(lamps), found.area, count);
    PointCloud cloud = sample_part(surface, shading, count - lamp_count, config, progress, found.warnings);
    if (lamp_count > 0) append(cloud, sample_part(lamps, shading, lamp_count, config, {}, found.warnings));
    report_progress(progress, "sample", 1);
    if (report != nullptr) *report = std::move(found);
    return cloud;
}

}  // namespace vmap
