// SPDX-License-Identifier: Apache-2.0
#include "channel_mean.h"
#include "direct_light.h"
#include "indirect_light.h"
#include "surface.h"

#include <vmap/error.h>
#include <vmap/light.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace vmap {
namespace {

using Imath::C3f;

/// So few emitters always get their closed form.
constexpr std::size_t few_emitters = 6;
/// Emitters at most so many times as bright as the scene on average make up much of what rays meet.
constexpr double dim_emission = 4;

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void check(const PointCloud& cloud, std::span<const LightSource> lights, const LightConfig& config) {
    if (!(config.tolerance > 0 && config.tolerance <= 1))
        throw UsageError("tolerance " + std::to_string(config.tolerance) + ": expected a value in (0, 1]");
    const auto positive = [](const C3f& c) { return c.x > 0 || c.y > 0 || c.z > 0; };
    const bool glows = std::any_of(cloud.emission.begin(), cloud.emission.end(), positive);
    const bool lit =
        std::any_of(lights.begin(), lights.end(), [&](const LightSource& light) { return positive(light.intensity); });
    const bool sound = std::all_of(config.sky.radiance.begin(), config.sky.radiance.end(), [](const C3f& c) {
        return c.x >= 0 && c.y >= 0 && c.z >= 0 && std::isfinite(c.x + c.y + c.z);
    });
    if (!sound) throw UsageError("the sky: expected finite values of 0 or more");
    const bool shines = std::any_of(config.sky.radiance.begin(), config.sky.radiance.end(), positive);
    if (!glows && !lit && !shines)
        throw UnsupportedInput("nothing emits light: expected a light source, an emissive surface or a sky");
}

/// Whether the rays of the indirect light shall see the emitters: they do it well where the emitters fill a good part
/// of the view, and have to where the closed form of every emitter at every tile would take too long.
bool shall_gather(const Surface& surface, std::span<const Emitter> emitters) {
    if (emitters.size() <= few_emitters) return false;
    const PointCloud& cloud = surface.cloud;
    const auto mean = [](const C3f& c) { return static_cast<double>(mean_of(c)); };
    double emitted = 0;
    double absorbed = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const auto area = static_cast<double>(cloud.areas[i]);
        emitted += mean(cloud.emission[i]) * area;
        absorbed += std::max(1 - mean(cloud.albedo[i]), 0.05) * area;
    }
    // The radiance of a closed scene whose light settles at what is absorbed.
    const double average = emitted / absorbed;
    return std::all_of(emitters.begin(), emitters.end(),
                       [&](const Emitter& emitter) { return mean(emitter.radiance) <= dim_emission * average; });
}

}  // namespace

LightResult compute_light(const PointCloud& cloud, std::span<const LightSource> lights, const LightConfig& config,
                          const ProgressCallback& progress) {
    check(cloud, lights, config);
    LightResult result;
    if (cloud.empty()) return result;

    auto start = std::chrono::steady_clock::now();
    report_progress(progress, "tree", 0);
    const Surface surface(cloud);
    result.report.patches = surface.set.patches.size();
    result.report.leaves = surface.tiles.size();
    result.report.nodes = surface.bvh.nodes().size();
    result.report.tree_seconds = seconds_since(start);

    start = std::chrono::steady_clock::now();
    std::vector<Emitter> emitters = find_emitters(surface);
    const bool gather_emission = shall_gather(surface, emitters);
    if (gather_emission) emitters.clear();
    result.irradiance = direct_light(surface, emitters, lights, config.tolerance, config.seed, progress);
    result.report.direct_seconds = seconds_since(start);

    start = std::chrono::steady_clock::now();
    const IndirectResult indirect = indirect_light(
        surface, result.irradiance, {config.tolerance, config.seed, gather_emission, config.sky}, progress);
    double sum = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        result.irradiance[i] += indirect.irradiance[i];
        const C3f& e = result.irradiance[i];
        sum += static_cast<double>(e.x + e.y + e.z) / 3;
    }
    const double mean = sum / static_cast<double>(cloud.size());
    result.report.receivers = indirect.receivers;
    result.report.rays = indirect.rays;
    result.report.indirect_seconds = seconds_since(start);
    result.report.error_mean = mean > 0 ? indirect.noise_mean / mean : 0;
    result.report.error_p95 = mean > 0 ? indirect.noise_p95 / mean : 0;
    result.report.converged = indirect.converged;
    if (!indirect.converged) {
        const bool mirror = std::any_of(cloud.albedo.begin(), cloud.albedo.end(),
                                        [](const C3f& a) { return std::max({a.x, a.y, a.z}) >= 1; });
        if (mirror)
            throw UnsupportedInput("the light does not settle: albedo 1 in a closed scene; expected albedo below 1");
        result.report.warnings.emplace_back("the light between the patches did not settle");
    }
    return result;
}

}  // namespace vmap
