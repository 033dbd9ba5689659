// SPDX-License-Identifier: GPL-3.0-or-later
#include <reference/measure.h>
#include <reference/owen_sobol.h>
#include <reference/reference_cache.h>
#include <vmap/error.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <vector>

namespace vmap::reference {
namespace {

using Imath::V3d;

constexpr std::size_t pilot_samples = 256;
constexpr std::size_t most_samples = std::size_t{1} << 20;
constexpr double change_at_silhouettes = 0.1;

/// Points that are looked at, and the area that each stands for.
struct Draw {
    std::vector<std::size_t> indices;
    std::vector<double> weights;
};

/// Systematic sampling: one draw from each of `count` equal pieces of the area in the order of the file. A point that
/// is drawn several times counts so much more.
Draw draw_by_area(const std::vector<double>& areas, std::size_t count, std::uint64_t seed) {
    Draw draw;
    if (count >= areas.size()) {
        draw.indices.resize(areas.size());
        std::iota(draw.indices.begin(), draw.indices.end(), std::size_t{0});
        draw.weights = areas;
        return draw;
    }
    const double step = std::accumulate(areas.begin(), areas.end(), 0.0) / static_cast<double>(count);
    double sum = 0;
    std::size_t next = 0;
    const auto place = [&](std::size_t k) {
        const double jitter = static_cast<double>(mix_keys(seed, k) >> 11) * 0x1p-53;
        return (static_cast<double>(k) + jitter) * step;
    };
    for (std::size_t i = 0; i < areas.size(); ++i) {
        sum += areas[i];
        double weight = 0;
        for (; next < count && place(next) < sum; ++next) weight += 1;
        if (!(weight > 0)) continue;
        draw.indices.push_back(i);
        draw.weights.push_back(weight);
    }
    return draw;
}

double mean_of(const Imath::C3f& color) {
    return (static_cast<double>(color.x) + color.y + color.z) / 3;
}

/// The truth at some points, as means of the channels.
struct Truth {
    std::vector<double> values;
    std::vector<double> errors;
};

Truth means_of(const std::vector<ReferenceValue>& traced) {
    Truth truth;
    for (const ReferenceValue& value : traced) {
        truth.values.push_back(mean_of(value.irradiance));
        truth.errors.push_back(value.mean_standard_error);
    }
    return truth;
}

class Measuring {
public:
    Measuring(const Scene& scene, const MeasureConfig& config, const ProgressCallback& progress)
        : scene_(scene), config_(config), progress_(progress) {}

    [[nodiscard]] Truth truth_at(const std::vector<ReferencePoint>& points, std::size_t samples,
                                 std::uint64_t run) const {
        const ReferenceConfig traced{
            .samples = samples, .max_bounces = config_.max_bounces, .seed = mix_keys(config_.seed, run)};
        return means_of(cached_irradiance(config_.cache, scene_, points, traced, progress_));
    }

    /// Errors of Monte Carlo fall with the root of the number of samples; scrambled sequences do no worse.
    [[nodiscard]] std::size_t samples_for_noise(const std::vector<ReferencePoint>& points,
                                                const std::vector<double>& weights) const {
        if (config_.samples > 0) return config_.samples;
        const Truth pilot = truth_at(points, pilot_samples, 0);
        const double noise = error_figures(pilot.values, pilot.values, pilot.errors, weights).noise;
        const double needed = static_cast<double>(pilot_samples) * std::pow(noise / config_.noise, 2);
        const double bounded =
            std::clamp(needed, static_cast<double>(pilot_samples), static_cast<double>(most_samples));
        return std::bit_ceil(static_cast<std::size_t>(bounded));
    }

    /// Which of the points see the truth change within one spacing.
    [[nodiscard]] std::vector<bool> near_silhouettes(const std::vector<ReferencePoint>& points, const Truth& truth,
                                                     double spacing, double mean, std::size_t samples) const {
        std::vector<ReferencePoint> moved;
        for (const ReferencePoint& point : points) {
            const V3d side = std::abs(point.normal.x) > 0.5 ? V3d(0, 1, 0) : V3d(1, 0, 0);
            const V3d first = point.normal.cross(side).normalized() * spacing;
            const V3d second = point.normal.cross(first);
            for (const V3d& step : {first, -first, second, -second})
                moved.push_back({.position = point.position + step, .normal = point.normal});
        }
        const Truth beside = truth_at(moved, std::max<std::size_t>(64, samples / 4), 2);
        std::vector<bool> near(points.size(), false);
        for (std::size_t i = 0; i < moved.size(); ++i) {
            const double change = std::abs(beside.values[i] - truth.values[i / 4]);
            const double noise = std::hypot(beside.errors[i], truth.errors[i / 4]);
            if (change > change_at_silhouettes * mean + 3 * noise) near[i / 4] = true;
        }
        return near;
    }

private:
    const Scene& scene_;
    const MeasureConfig& config_;
    const ProgressCallback& progress_;
};

}  // namespace

Measurement measure(const Scene& scene, const LitPly& cloud, const MeasureConfig& config,
                    const ProgressCallback& progress) {
    const double area = std::accumulate(cloud.areas.begin(), cloud.areas.end(), 0.0);
    if (!(area > 0)) throw UnsupportedInput("the cloud has no points with an area");
    const Draw draw = draw_by_area(cloud.areas, config.points, config.seed);

    std::vector<ReferencePoint> points;
    std::vector<double> result;
    for (const std::size_t i : draw.indices) {
        points.push_back({.position = cloud.positions[i], .normal = cloud.normals[i], .face = cloud.faces[i]});
        result.push_back(mean_of(cloud.irradiance[i]));
    }
    const Measuring measuring(scene, config, progress);
    Measurement measurement;
    measurement.samples = measuring.samples_for_noise(points, draw.weights);
    const Truth truth = measuring.truth_at(points, measurement.samples, 1);
    measurement.all = error_figures(result, truth.values, truth.errors, draw.weights);
    if (!config.away_from_silhouettes) return measurement;

    const double spacing = std::sqrt(area / static_cast<double>(cloud.size()));
    const std::vector<bool> near =
        measuring.near_silhouettes(points, truth, spacing, measurement.all.mean_truth, measurement.samples);
    std::vector<double> weights = draw.weights;
    for (std::size_t i = 0; i < weights.size(); ++i)
        if (near[i]) weights[i] = 0;
    measurement.away = error_figures(result, truth.values, truth.errors, weights);
    const double kept = std::accumulate(weights.begin(), weights.end(), 0.0);
    measurement.left_out = 1 - kept / std::accumulate(draw.weights.begin(), draw.weights.end(), 0.0);
    return measurement;
}

}  // namespace vmap::reference
