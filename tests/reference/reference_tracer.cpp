// SPDX-License-Identifier: GPL-3.0-or-later
#include <reference/emitters.h>
#include <reference/owen_sobol.h>
#include <reference/ray_scene.h>
#include <reference/reference_tracer.h>

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <numbers>

namespace vmap::reference {
namespace {

using Imath::C3f;
using Imath::V2d;
using Imath::V3d;
using std::numbers::pi;

constexpr int replicates = 16;  ///< independent scramblings whose scatter is the error
constexpr double roulette_below = 0.25;

/// Distance from its face, in steps off a surface, up to which a point counts as moved by rounding.
constexpr double largest_correction = 100;

/// Where light is gathered.
struct Receiver {
    V3d position;    ///< on the surface
    V3d normal;      ///< of the side that light comes from
    V3d ray_origin;  ///< a step off the surface
};

/// The random numbers of one path.
struct PathNumbers {
    std::uint64_t key;
    std::uint32_t index;

    enum class Purpose { direction = 0, emitter = 1, choice = 2 };
    [[nodiscard]] V2d at(int bounce, Purpose purpose) const {
        return scrambled_sobol(mix_keys(key, static_cast<std::uint64_t>(bounce) * 4 + static_cast<int>(purpose)),
                               index);
    }
};

V3d vector_of(const C3f& color) {
    return {color.x, color.y, color.z};
}

V3d scaled(const V3d& a, const V3d& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}

double largest(const V3d& v) {
    return std::max({v.x, v.y, v.z});
}

/// A direction about the normal with density cos / pi.
V3d cosine_direction(const V3d& normal, const V2d& sample) {
    const V3d side = std::abs(normal.x) > 0.5 ? V3d(0, 1, 0) : V3d(1, 0, 0);
    const V3d tangent = normal.cross(side).normalized();
    const double radius = std::sqrt(sample.x);
    const double angle = 2 * pi * sample.y;
    const V3d direction = tangent * (radius * std::cos(angle)) + normal.cross(tangent) * (radius * std::sin(angle)) +
                          normal * std::sqrt(1 - sample.x);
    return direction.normalized();
}

/// Weight of one of two samplings by the balance heuristic.
double balance(double density, double other) {
    return density / (density + other);
}

/// Irradiance that a light without surface would give if nothing stood between, and where it comes from.
struct Unshadowed {
    V3d irradiance{0, 0, 0};
    V3d direction{0, 0, 0};  ///< to the light, unit
    double distance = 0;     ///< infinite for a sun
};

double cone_share(const LightSource& spot, double cos_angle) {
    const double inner = std::cos(spot.inner_cone_angle);
    const double outer = std::cos(spot.outer_cone_angle);
    if (cos_angle >= inner) return 1;
    if (cos_angle <= outer) return 0;
    const double t = (cos_angle - outer) / (inner - outer);
    return t * t;
}

Unshadowed unshadowed(const LightSource& light, const V3d& light_position, const Receiver& receiver) {
    Unshadowed result;
    if (light.kind == LightKind::sun) {
        result.direction = -light.direction;
        result.distance = std::numeric_limits<double>::infinity();
        result.irradiance = vector_of(light.intensity) * std::max(0.0, receiver.normal.dot(result.direction));
        return result;
    }
    const V3d way = light_position - receiver.position;
    result.distance = way.length();
    if (!(result.distance > 0)) return result;
    result.direction = way / result.distance;
    double share = std::max(0.0, receiver.normal.dot(result.direction)) / (result.distance * result.distance);
    if (light.kind == LightKind::spot) share *= cone_share(light, -light.direction.dot(result.direction));
    result.irradiance = vector_of(light.intensity) * share;
    return result;
}

class Tracer {
public:
    Tracer(const Scene& scene, const ReferenceConfig& config)
        : lights_(&scene.lights), config_(config), rays_(scene), emitters_(rays_), sky_(vector_of(config.sky)) {}

    [[nodiscard]] ReferenceValue value_at(const ReferencePoint& point, std::uint64_t key) const {
        const Receiver receiver = receiver_of(point);
        const V3d exact = light_of_all_sources(receiver);
        const auto paths =
            static_cast<std::uint32_t>(std::max<std::size_t>(1, (config_.samples + replicates - 1) / replicates));

        V3d sum(0);
        V3d squares(0);
        double mean_squares = 0;
        for (int r = 0; r < replicates; ++r) {
            const std::uint64_t replicate_key = mix_keys(key, r);
            V3d estimate(0);
            for (std::uint32_t i = 0; i < paths; ++i) estimate += trace(receiver, {replicate_key, i});
            estimate /= paths;
            sum += estimate;
            squares += scaled(estimate, estimate);
            const double mean = (estimate.x + estimate.y + estimate.z) / 3;
            mean_squares += mean * mean;
        }
        const V3d mean = sum / replicates;
        const auto error_of = [](double mean_of_squares, double value) {
            return static_cast<float>(std::sqrt(std::max(0.0, mean_of_squares - value * value) / (replicates - 1)));
        };
        ReferenceValue value;
        for (int c = 0; c < 3; ++c) {
            value.irradiance[c] = static_cast<float>(mean[c] + exact[c]);
            value.standard_error[c] = error_of(squares[c] / replicates, mean[c]);
        }
        value.mean_standard_error = error_of(mean_squares / replicates, (mean.x + mean.y + mean.z) / 3);
        return value;
    }

private:
    [[nodiscard]] Receiver receiver_of(const ReferencePoint& point) const {
        V3d position = point.position - rays_.origin();
        if (point.face >= rays_.face_count()) return {position, point.normal, position + point.normal * rays_.offset()};
        const V3d normal = rays_.front_normal(point.face);
        const double height = (position - rays_.triangle(point.face)[0]).dot(normal);
        if (std::abs(height) < largest_correction * rays_.offset()) position -= normal * height;
        return {position, point.normal, position + point.normal * rays_.offset(point.face)};
    }

    [[nodiscard]] Receiver receiver_of(const RayHit& hit) const {
        return {hit.position, hit.normal, hit.position + hit.normal * rays_.offset(hit.face)};
    }

    [[nodiscard]] V3d light_position(const LightSource& light) const { return light.position - rays_.origin(); }

    [[nodiscard]] bool reaches(const Receiver& receiver, const Unshadowed& light) const {
        if (std::isinf(light.distance)) return !rays_.is_blocked_to_infinity(receiver.ray_origin, light.direction);
        return !rays_.is_blocked(receiver.ray_origin, receiver.position + light.direction * light.distance);
    }

    /// Points, spots and suns need no sampling at the first receiver.
    [[nodiscard]] V3d light_of_all_sources(const Receiver& receiver) const {
        V3d sum(0);
        for (const LightSource& source : *lights_) {
            const Unshadowed light = unshadowed(source, light_position(source), receiver);
            if (largest(light.irradiance) > 0 && reaches(receiver, light)) sum += light.irradiance;
        }
        return sum;
    }

    /// The same for receivers along a path: one source, taken by what it would give if nothing stood between.
    [[nodiscard]] V3d light_of_one_source(const Receiver& receiver, double sample) const {
        double total = 0;
        for (const LightSource& source : *lights_)
            total += largest(unshadowed(source, light_position(source), receiver).irradiance);
        if (!(total > 0)) return V3d(0);
        double left = sample * total;
        for (const LightSource& source : *lights_) {
            const Unshadowed light = unshadowed(source, light_position(source), receiver);
            const double power = largest(light.irradiance);
            left -= power;
            if (power > 0 && left < 0) return reaches(receiver, light) ? light.irradiance * (total / power) : V3d(0);
        }
        return V3d(0);
    }

    /// One place on the emissive surfaces, weighted against its chance to be hit by a cosine ray.
    [[nodiscard]] V3d light_of_one_emitter(const Receiver& receiver, const V2d& sample) const {
        const EmitterSample chosen = emitters_.choose(sample);
        const V3d way = chosen.position - receiver.position;
        const double distance2 = way.length2();
        if (!(distance2 > 0)) return V3d(0);
        const V3d direction = way / std::sqrt(distance2);
        const double cos_receiver = receiver.normal.dot(direction);
        V3d side = rays_.front_normal(chosen.face);
        double cos_emitter = -side.dot(direction);
        if (cos_emitter < 0 && rays_.shading().material(chosen.place).double_sided) {
            cos_emitter = -cos_emitter;
            side = -side;
        }
        if (!(cos_receiver > 0) || !(cos_emitter > 0)) return V3d(0);
        if (rays_.shading().is_cut(chosen.place)) return V3d(0);
        if (rays_.is_blocked(receiver.ray_origin, chosen.position + side * rays_.offset(chosen.face))) return V3d(0);
        const double density = chosen.density * distance2 / cos_emitter;
        const double weight = balance(density, cos_receiver / pi);
        return vector_of(rays_.shading().emission(chosen.place)) * (cos_receiver / density * weight);
    }

    /// Density per solid angle with which a hit would have been chosen as a place on an emitter.
    [[nodiscard]] double emitter_density(const Receiver& receiver, const RayHit& hit) const {
        const V3d way = hit.position - receiver.position;
        const double distance = way.length();
        return emitters_.density(hit.face) * distance * distance * distance / std::abs(hit.normal.dot(way));
    }

    [[nodiscard]] bool may_bounce(int bounce) const {
        return bounce < std::min(config_.max_bounces, ReferenceConfig::all_bounces);
    }

    /// Irradiance by one path, without the sources that light_of_all_sources gives.
    [[nodiscard]] V3d trace(Receiver receiver, const PathNumbers& numbers) const {
        V3d irradiance(0);
        V3d weight(1);  // of irradiance at the path's current receiver
        for (int bounce = 0;; ++bounce) {
            const V2d choice = numbers.at(bounce, PathNumbers::Purpose::choice);
            if (bounce > 0 && !lights_->empty()) irradiance += scaled(weight, light_of_one_source(receiver, choice.x));
            if (!emitters_.empty())
                irradiance +=
                    scaled(weight, light_of_one_emitter(receiver, numbers.at(bounce, PathNumbers::Purpose::emitter)));

            const V3d direction =
                cosine_direction(receiver.normal, numbers.at(bounce, PathNumbers::Purpose::direction));
            const double cos_receiver = receiver.normal.dot(direction);
            const std::optional<RayHit> hit = rays_.first_hit(receiver.ray_origin, direction);
            if (!hit) return irradiance + scaled(weight, sky_) * pi;
            if (!hit->lit_side) return irradiance;
            if (rays_.shading().material(hit->place).emits()) {
                const double share = balance(cos_receiver / pi, emitter_density(receiver, *hit));
                irradiance += scaled(weight, vector_of(rays_.shading().emission(hit->place))) * (pi * share);
            }

            if (!may_bounce(bounce)) return irradiance;
            const V3d albedo = vector_of(rays_.shading().albedo(hit->place));
            for (int c = 0; c < 3; ++c) weight[c] *= std::clamp(albedo[c], 0.0, 1.0);
            const double strength = largest(weight);
            if (strength < roulette_below) {
                const double survival = strength / roulette_below;
                if (choice.y >= survival) return irradiance;
                weight /= survival;
            }
            receiver = receiver_of(*hit);
        }
    }

    const std::vector<LightSource>* lights_;
    ReferenceConfig config_;
    RayScene rays_;
    Emitters emitters_;
    V3d sky_;
};

}  // namespace

std::vector<ReferenceValue> trace_irradiance(const Scene& scene, std::span<const ReferencePoint> points,
                                             const ReferenceConfig& config, const ProgressCallback& progress) {
    const Tracer tracer(scene, config);
    std::vector<ReferenceValue> values(points.size());
    std::mutex report;
    std::size_t done = 0;
    tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
        values[i] = tracer.value_at(points[i], mix_keys(config.seed, i));
        const std::scoped_lock lock(report);
        ++done;
        report_progress(progress, "trace", static_cast<double>(done) / static_cast<double>(points.size()));
    });
    return values;
}

}  // namespace vmap::reference
