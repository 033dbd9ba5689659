// SPDX-License-Identifier: Apache-2.0
#include "direct_light.h"

#include "sampling.h"
#include "shaft.h"

#include <vmap/outline.h>
#include <vmap/polygon_light.h>

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>

namespace vmap {
namespace {

using Imath::Box3f;
using Imath::C3f;
using Imath::V2d;
using Imath::V3d;
using Imath::V3f;

constexpr std::size_t exact_blockers = 12;       ///< with more of them shadow rays are cheaper than clipping
constexpr std::uint32_t shadow_ray_count = 128;  ///< per point that sees a part of a light behind many blockers

V3d world_of(const Patch& patch, const V2d& q) {
    return V3d(patch.center) + V3d(patch.u) * q.x + V3d(patch.v) * q.y;
}

Emitter make_emitter(std::vector<V3d> vertices, const Patch& patch, std::uint32_t index, const C3f& radiance) {
    Emitter emitter{std::move(vertices), patch.normal, {}, radiance, index};
    for (const V3d& v : emitter.vertices) emitter.bounds.extendBy(V3f(v));
    return emitter;
}

/// Area-weighted mean of the emission of a range of points, and whether they differ.
struct MeanEmission {
    C3f mean{0, 0, 0};
    double area = 0;
    bool uniform = true;
};
MeanEmission mean_emission(const Surface& surface, std::uint32_t first, std::uint32_t count) {
    V3d sum(0);
    MeanEmission result;
    const C3f& probe = surface.cloud.emission[surface.set.point_order[first]];
    for (std::uint32_t k = first; k < first + count; ++k) {
        const std::uint32_t i = surface.set.point_order[k];
        const auto area = static_cast<double>(surface.cloud.areas[i]);
        sum += V3d(surface.cloud.emission[i]) * area;
        result.area += area;
        result.uniform = result.uniform && (surface.cloud.emission[i] - probe).length() <= 1e-3F * probe.length();
    }
    sum /= result.area;
    result.mean = C3f(static_cast<float>(sum.x), static_cast<float>(sum.y), static_cast<float>(sum.z));
    return result;
}

/// Points on an emitter, spread evenly over its area.
class EmitterSampler {
public:
    explicit EmitterSampler(const Emitter& emitter) : vertices_(emitter.vertices) {
        for (std::size_t i = 1; i + 1 < vertices_.size(); ++i) {
            total_ += (vertices_[i] - vertices_[0]).cross(vertices_[i + 1] - vertices_[0]).length();
            sums_.push_back(total_);
        }
    }

    [[nodiscard]] V3d at(const V2d& sample) const {
        const double target = sample.x * total_;
        std::size_t i = 0;
        while (i + 1 < sums_.size() && sums_[i] < target) ++i;
        const double before = i == 0 ? 0 : sums_[i - 1];
        const double width = sums_[i] - before;
        const double along = std::sqrt(width > 0 ? std::clamp((target - before) / width, 0.0, 1.0) : 0.5);
        return vertices_[0] * (1 - along) + vertices_[i + 1] * (along * (1 - sample.y)) +
               vertices_[i + 2] * (along * sample.y);
    }

private:
    std::span<const V3d> vertices_;
    std::vector<double> sums_;
    double total_ = 0;
};

/// Lights one tile; holds what is used again from light to light.
class TileLighter {
public:
    TileLighter(const Surface& surface, const Tile& tile, std::uint64_t seed, std::span<C3f> irradiance)
        : surface_(surface),
          tile_(tile),
          patch_(surface.set.patches[tile.patch]),
          clearance_(patch_.flat ? 4e-6F * surface.diagonal : 0.35F * patch_.spacing()),
          seed_(seed),
          irradiance_(irradiance) {}

    void add(const Emitter& emitter) {
        if (emitter.patch == tile_.patch || below_horizon(emitter.vertices) || behind(emitter)) return;
        find_blockers(emitter.bounds, [&](std::uint32_t other, std::span<const V3f> outline) {
            return other != emitter.patch && std::any_of(outline.begin(), outline.end(), [&](const V3f& v) {
                       return emitter.normal.dot(v - V3f(emitter.vertices[0])) > 4e-6F * surface_.diagonal;
                   });
        });
        const EmitterSampler sampler(emitter);
        for_each_point([&](std::uint32_t i, const V3d& position, const V3d& normal) {
            double light = 0;
            if (blockers_.empty()) {
                light = polygon_irradiance(position, normal, emitter.vertices);
            } else {
                std::optional<double> exact;
                if (blockers_.size() <= exact_blockers)
                    exact = visible_polygon_irradiance(position, normal, emitter.vertices, blockers_,
                                                       static_cast<double>(clearance_));
                light = exact ? *exact : sampled(i, position, normal, emitter, sampler);
            }
            irradiance_[i] += emitter.radiance * static_cast<float>(light);
        });
    }

    void add(const LightSource& source) {
        const bool sun = source.kind == LightKind::sun;
        const V3d place = source.position - surface_.cloud.origin;
        Box3f end(V3f{place});
        if (sun) {
            const V3f away = V3f(source.direction) * (-2 * surface_.diagonal);
            end = {tile_.bounds.min + away, tile_.bounds.max + away};
        }
        find_blockers(end, [](std::uint32_t, std::span<const V3f>) { return true; });
        for_each_point([&](std::uint32_t i, const V3d& position, const V3d& normal) {
            const V3d to_light =
                sun ? -source.direction * (2.0 * static_cast<double>(surface_.diagonal)) : place - position;
            const double distance = to_light.length();
            if (!(distance > 0)) return;
            double light = normal.dot(to_light) / distance;
            if (light <= 0) return;
            if (!sun) light /= distance * distance;
            if (source.kind == LightKind::spot)
                light *= spot_falloff(source, -source.direction.dot(to_light) / distance);
            if (light <= 0) return;
            if (!blockers_.empty()) {
                const V3d start = position + normal * static_cast<double>(clearance_);
                if (surface_.bvh.any_hit({V3f(start), V3f(position + to_light - start), 0, 1 - 1e-5F})) return;
            }
            irradiance_[i] += source.intensity * static_cast<float>(light);
        });
    }

private:
    template <class Use>
    void for_each_point(const Use& use) const {
        for (std::uint32_t k = tile_.first_point; k < tile_.first_point + tile_.point_count; ++k) {
            const std::uint32_t i = surface_.set.point_order[k];
            use(i, V3d(surface_.cloud.positions[i]), V3d(surface_.normal_of(patch_, i)));
        }
    }

    [[nodiscard]] bool below_horizon(std::span<const V3d> vertices) const {
        if (!patch_.flat) return false;
        return std::all_of(vertices.begin(), vertices.end(), [&](const V3d& v) {
            return patch_.normal.dot(V3f(v) - patch_.center) <= 4e-6F * surface_.diagonal;
        });
    }

    /// Whether the whole tile lies behind the emitter.
    [[nodiscard]] bool behind(const Emitter& emitter) const {
        V3f foremost = tile_.bounds.min;
        for (int axis = 0; axis < 3; ++axis)
            if (emitter.normal[axis] > 0) foremost[axis] = tile_.bounds.max[axis];
        return emitter.normal.dot(foremost - V3f(emitter.vertices[0])) <= 4e-6F * surface_.diagonal;
    }

    /// Collects the outlines that reach into the shaft from the tile to the box and above the tile's own plane.
    template <class Keep>
    void find_blockers(const Box3f& end, const Keep& keep) {
        const Shaft shaft(tile_.bounds, end);
        found_.clear();
        surface_.bvh.polygons_in(shaft.half_spaces(), found_);
        std::sort(found_.begin(), found_.end());
        blockers_.clear();
        for (const std::uint32_t other : found_) {
            if (other == tile_.patch) continue;
            const std::span<const V3f> outline = surface_.set.outlines[other];
            const auto above = [&](const V3f& v) { return patch_.normal.dot(v - patch_.center) > clearance_; };
            if (patch_.flat && std::none_of(outline.begin(), outline.end(), above)) continue;
            if (!keep(other, outline) || !shaft.may_hold(outline)) continue;
            blockers_.emplace_back();
            for (const V3f& v : outline) blockers_.back().emplace_back(v);
        }
    }

    /// The closed form times the share of the light that shadow rays reach, each weighted by what it would bring.
    [[nodiscard]] double sampled(std::uint32_t point, const V3d& position, const V3d& normal, const Emitter& emitter,
                                 const EmitterSampler& sampler) const {
        const double unblocked = polygon_irradiance(position, normal, emitter.vertices);
        if (unblocked <= 0) return 0;
        const V3d start = position + normal * static_cast<double>(clearance_);
        std::array<Ray, shadow_ray_count> rays;
        std::array<std::uint8_t, shadow_ray_count> blocked{};
        std::array<double, shadow_ray_count> weights{};
        const std::uint64_t key = seed_ * 0x9E3779B97F4A7C15ULL + (std::uint64_t{point} << 20) + emitter.patch;
        for (std::uint32_t k = 0; k < shadow_ray_count; ++k) {
            const V3d target = sampler.at(shifted_r2(key, k));
            const V3d way = target - position;
            const double square = way.length2();
            weights[k] = std::max(normal.dot(way), 0.0) * std::max(-V3d(emitter.normal).dot(way), 0.0) /
                         std::max(square * square, 1e-300);
            rays[k] = {V3f(start), V3f(target - start), 0, 1 - 1e-4F};
        }
        surface_.bvh.any_hits(rays, blocked);
        double seen = 0;
        double all = 0;
        for (std::uint32_t k = 0; k < shadow_ray_count; ++k) {
            all += weights[k];
            if (blocked[k] == 0) seen += weights[k];
        }
        return all > 0 ? unblocked * seen / all : 0;
    }

    const Surface& surface_;
    const Tile& tile_;
    const Patch& patch_;
    float clearance_;
    std::uint64_t seed_;
    std::span<C3f> irradiance_;
    std::vector<std::uint32_t> found_;
    std::vector<std::vector<V3d>> blockers_;
};

}  // namespace

std::vector<Emitter> find_emitters(const Surface& surface) {
    std::vector<Emitter> emitters;
    std::size_t tile = 0;
    for (std::uint32_t p = 0; p < surface.set.patches.size(); ++p) {
        const Patch& patch = surface.set.patches[p];
        const std::size_t first_tile = tile;
        while (tile < surface.tiles.size() && surface.tiles[tile].patch == p) ++tile;
        if (!patch.emits) continue;
        const MeanEmission whole = mean_emission(surface, patch.first_point, patch.point_count);
        if (whole.uniform || !patch.flat) {
            std::vector<V3d> vertices;
            for (const V3f& v : surface.set.outlines[p]) vertices.emplace_back(v);
            emitters.push_back(make_emitter(std::move(vertices), patch, p, whole.mean));
            continue;
        }
        for (std::size_t t = first_tile; t < tile; ++t) {
            const Tile& part = surface.tiles[t];
            const MeanEmission own = mean_emission(surface, part.first_point, part.point_count);
            std::vector<V2d> flat;
            for (std::uint32_t k = part.first_point; k < part.first_point + part.point_count; ++k)
                flat.emplace_back(patch.to_plane(surface.cloud.positions[surface.set.point_order[k]]));
            std::vector<V3d> vertices;
            for (const V2d& q : rough_outline(flat, own.area, static_cast<double>(patch.spacing())))
                vertices.push_back(world_of(patch, q));
            emitters.push_back(make_emitter(std::move(vertices), patch, p, own.mean));
        }
    }
    return emitters;
}

std::vector<C3f> direct_light(const Surface& surface, std::span<const Emitter> emitters,
                              std::span<const LightSource> lights, std::uint64_t seed,
                              const ProgressCallback& progress) {
    std::vector<C3f> irradiance(surface.cloud.size(), C3f(0, 0, 0));
    std::atomic<std::size_t> done{0};
    std::mutex reporting;
    tbb::parallel_for(std::size_t{0}, surface.tiles.size(), [&](std::size_t t) {
        TileLighter lighter(surface, surface.tiles[t], seed, irradiance);
        for (const Emitter& emitter : emitters) lighter.add(emitter);
        for (const LightSource& light : lights) lighter.add(light);
        const std::size_t count = ++done;
        if (count % 256 != 0) return;
        const std::lock_guard lock(reporting);
        report_progress(progress, "direct", static_cast<double>(count) / static_cast<double>(surface.tiles.size()));
    });
    return irradiance;
}

}  // namespace vmap
