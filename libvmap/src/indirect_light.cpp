// SPDX-License-Identifier: Apache-2.0
#include "indirect_light.h"

#include "channel_mean.h"
#include "curved_light.h"
#include "gather_directions.h"
#include "gmres.h"
#include "local_fit.h"
#include "receivers.h"
#include "sampling.h"
#include "texels.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <numbers>

namespace vmap {
namespace {

using Imath::C3f;
using Imath::V2f;
using Imath::V3f;

constexpr std::uint32_t no_texel = 0xFFFFFFFFU;
/// A receiver is buried if most of its rays meet the back of something nearer than that many spacings and its patch has
/// no points there: it lies where the outline reaches under the next one.
constexpr float buried_below = 3;

C3f product(const C3f& a, const C3f& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}

/// How finely light is gathered for a tolerance.
struct Fineness {
    std::uint32_t rays = 64;  ///< per receiver, a power of two
    float cell = 1;           ///< edge of the coarsest cells of receivers, world units
    float finest = 5;         ///< edge of the finest cells, in spacings of the points
    float cut_above = 0.1F;   ///< difference from the smooth light that cuts a cell, of the mean irradiance

    Fineness(double tolerance, float diagonal) {
        const double ease = tolerance / 0.01;
        rays = std::bit_ceil(static_cast<std::uint32_t>(std::clamp(256 / ease, 32.0, 4096.0)));
        cell = diagonal * static_cast<float>(std::clamp(std::cbrt(ease) / 40, 1.0 / 128, 1.0 / 16));
        cut_above = static_cast<float>(0.1 * std::clamp(std::sqrt(ease), 0.4, 3.0));
        finest = static_cast<float>(5 * std::clamp(std::sqrt(ease), 0.4, 2.0));
    }
};

class Gatherer {
public:
    Gatherer(const Surface& surface, const std::vector<C3f>& direct, const IndirectConfig& config)
        : surface_(surface),
          direct_(direct),
          config_(config),
          fineness_(config.tolerance, surface.diagonal),
          directions_(fineness_.rays, config.seed),
          texels_(surface, fineness_.cell / 4) {}

    IndirectResult run(const ProgressCallback& progress) {
        place_receivers();
        average_surface();
        trace();
        fit_ = std::make_unique<LocalFit>(surface_, grids_, receivers_);
        // The first reflection has the sharpest features: it says where to refine, without solving for the rest.
        for (std::uint32_t level = 0; level < ReceiverGrid::max_level; ++level) {
            report_progress(progress, "indirect", 0.3 + 0.15 * level);
            if (!refine(level, gather(first_radiosity_))) break;
            trace();
            fit_ = std::make_unique<LocalFit>(surface_, grids_, receivers_);
        }
        place_texels(true);
        report_progress(progress, "indirect", 0.75);
        const double residual = std::min(1e-3, 0.05 * config_.tolerance);
        const FixedPointResult solution = solve(residual);

        IndirectResult result;
        result.irradiance = at_points(solution.x);
        result.receivers = receivers_.size();
        result.rays = receivers_.size() * fineness_.rays;
        result.converged = solution.residual <= residual;
        measure_noise(solution.x, result);
        return result;
    }

private:
    void place_receivers() {
        grid_of_.resize(surface_.set.patches.size());
        center_of_.assign(surface_.set.patches.size(), 0);
        for (std::uint32_t p = 0; p < surface_.set.patches.size(); ++p) {
            const Patch& patch = surface_.set.patches[p];
            if (patch.flat) {
                grid_of_[p] = static_cast<std::uint32_t>(grids_.size());
                grids_.emplace_back(surface_, p, fineness_.cell, fineness_.finest * patch.spacing(), receivers_);
            } else {
                center_of_[p] = static_cast<std::uint32_t>(receivers_.size());
                receivers_.push_back({patch.center, patch.normal, V2f(0, 0), p, static_cast<std::uint32_t>(hash64(p))});
            }
        }
    }

    /// Albedo of the texels, and what they send out before any reflection of indirect light.
    void average_surface() {
        albedo_ = texels_.means_of(surface_.cloud.albedo);
        std::vector<C3f> sent(surface_.cloud.size());
        tbb::parallel_for(std::size_t{0}, sent.size(), [&](std::size_t i) {
            sent[i] = product(surface_.cloud.albedo[i], direct_[i]);
            if (config_.gather_emission && surface_.cloud.emits())
                sent[i] += surface_.cloud.emission[i] * std::numbers::pi_v<float>;
        });
        first_radiosity_ = texels_.means_of(sent);
        for (const C3f& radiance : config_.sky.radiance)
            first_radiosity_.push_back(radiance * std::numbers::pi_v<float>);
    }

    void place_texels(bool careful) {
        places_.resize(texels_.size());
        tbb::parallel_for(std::size_t{0}, surface_.set.patches.size(), [&](std::size_t p) {
            const TexelRaster& raster = texels_.raster(p);
            for (int y = 0; y < raster.height; ++y)
                for (int x = 0; x < raster.width; ++x)
                    places_[raster.index(x, y)] = surface_.set.patches[p].flat
                                                      ? fit_->locate(grids_[grid_of_[p]], raster.middle(x, y), careful)
                                                      : FieldPlace{{center_of_[p], 0, 0, 0}, {1, 0, 0, 0}, V2f(0, 0)};
        });
    }

    /// The receiver's own turn about its normal: none on flat patches, where neighbours complete each other.
    [[nodiscard]] NormalFrame frame_of(std::size_t r) const {
        const Receiver& receiver = receivers_[r];
        NormalFrame frame(receiver.normal);
        if (surface_.set.patches[receiver.patch].flat) return frame;
        const float angle = static_cast<float>(hash64(r) >> 40) * (2 * std::numbers::pi_v<float> * 0x1p-24F);
        const V3f x = frame.x * std::cos(angle) + frame.y * std::sin(angle);
        frame.y = frame.z.cross(x);
        frame.x = x;
        return frame;
    }

    /// Rays of the receivers that have none yet.
    void trace() {
        const std::size_t first = hits_.size() / fineness_.rays;
        hits_.resize(receivers_.size() * fineness_.rays, no_texel);
        tbb::parallel_for(first, receivers_.size(), [&](std::size_t r) { trace_receiver(r); });
    }

    void trace_receiver(std::size_t r) {
        Receiver& receiver = receivers_[r];
        const NormalFrame frame = frame_of(r);
        const V3f origin =
            receiver.position + receiver.normal * surface_.gather_offset(surface_.set.patches[receiver.patch]);
        const DirectionSet directions = directions_.set(receiver.direction_set);
        std::vector<RayHit> hits(directions.size());
        surface_.pencils.first_hits(origin, frame, directions, hits);
        std::size_t backs = 0;
        for (std::size_t k = 0; k < hits.size(); ++k) {
            Ray ray{origin, frame.world_from_local(directions[k])};
            RayHit hit = hits[k];
            const bool open = !hit;
            if (hit && !hit.front && !surface_.set.patches[hit.polygon].flat) {
                // The back of a group: a neighbour that pokes through the curve. Start clear of it.
                ray.origin = receiver.position + receiver.normal * (2 * surface_.set.patches[hit.polygon].spacing());
                hit = surface_.bvh.first_hit(ray);
            }
            if (!hit || !hit.front) {
                if (hit) ray.t_max = hit.t;
                hit = surface_.hit_in_crack(ray);
            }
            if (!hit) {
                if (open && !config_.sky.empty()) hits_[r * hits.size() + k] = sky_texel(ray.direction);
                if (!open && folds_over(receiver, hits[k])) ++backs;
                continue;
            }
            const Patch& met = surface_.set.patches[hit.polygon];
            const TexelRaster& raster = texels_.raster(hit.polygon);
            hits_[r * hits.size() + k] =
                met.flat ? raster.at(met.to_plane(ray.origin + ray.direction * hit.t)) : raster.first;
        }
        receiver.buried = 2 * backs > hits.size();
    }

    /// Whether a patch that a ray met from behind goes on where the receiver's own one ends, at a fold.
    [[nodiscard]] bool folds_over(const Receiver& receiver, const RayHit& hit) const {
        const float turn = surface_.set.patches[hit.polygon].normal.dot(receiver.normal);
        return hit.t < buried_below * surface_.set.patches[receiver.patch].spacing() && turn > 0.3F && turn < 0.9999F;
    }

    /// The sky stands behind the texels of the patches. It reflects nothing.
    [[nodiscard]] std::uint32_t sky_texel(const V3f& direction) const {
        return static_cast<std::uint32_t>(texels_.size() + config_.sky.at(direction));
    }

    [[nodiscard]] std::span<const std::uint32_t> hits_of(std::size_t r) const {
        return std::span(hits_).subspan(r * fineness_.rays, fineness_.rays);
    }

    [[nodiscard]] std::vector<float> gather(const std::vector<C3f>& radiosity) const {
        std::vector<float> gathered(receivers_.size() * 3);
        tbb::parallel_for(std::size_t{0}, receivers_.size(), [&](std::size_t r) {
            C3f sum(0, 0, 0);
            for (const std::uint32_t texel : hits_of(r))
                if (texel != no_texel) sum += radiosity[texel];
            for (int c = 0; c < 3; ++c)
                gathered[3 * r + static_cast<std::size_t>(c)] = sum[c] / static_cast<float>(fineness_.rays);
        });
        return gathered;
    }

    /// What the texels reflect of the indirect light alone.
    [[nodiscard]] std::vector<C3f> reflected(const std::vector<float>& x) const {
        const std::vector<Quadratic> field = fit_->fit(x);
        std::vector<C3f> radiosity(first_radiosity_.size(), C3f(0, 0, 0));
        tbb::parallel_for(std::size_t{0}, texels_.size(), [&](std::size_t t) {
            radiosity[t] = product(albedo_[t], fit_->value_at(places_[t], field));
        });
        return radiosity;
    }

    [[nodiscard]] FixedPointResult solve(double tolerance) const {
        return solve_fixed_point(
            gather(first_radiosity_), [&](const std::vector<float>& x) { return gather(reflected(x)); }, tolerance);
    }

    /// Cuts the cells of a level that something stands on, or whose corners the smooth light does not fit.
    bool refine(std::uint32_t level, const std::vector<float>& x) {
        double sum = 0;
        for (const C3f& e : direct_) sum += static_cast<double>(mean_of(e));
        double indirect = 0;
        for (const float value : x) indirect += static_cast<double>(value);
        const double mean = sum / static_cast<double>(std::max<std::size_t>(direct_.size(), 1)) +
                            indirect / static_cast<double>(std::max<std::size_t>(x.size(), 1));
        const std::vector<float> misfit = misfits(x);
        std::vector<float> sorted = misfit;
        const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
        std::nth_element(sorted.begin(), middle, sorted.end());
        const float noise = sorted.empty() ? 0 : *middle;
        const float limit = std::max(fineness_.cut_above * static_cast<float>(mean), 5 * noise);

        const std::size_t before = receivers_.size();
        for (ReceiverGrid& grid : grids_) {
            const std::size_t count = grid.cells().size();
            for (std::size_t c = 0; c < count; ++c) {
                const ReceiverGrid::Cell& cell = grid.cells()[c];
                if (cell.level != level || cell.first_child != 0 || grid.is_finest(cell)) continue;
                const bool rough = std::any_of(cell.vertex.begin(), cell.vertex.end(),
                                               [&](std::uint32_t r) { return misfit[r] > limit; });
                if (cell.contact || rough) grid.cut(c, receivers_);
            }
        }
        return receivers_.size() > before;
    }

    /// Difference of every receiver from the light fitted around it.
    [[nodiscard]] std::vector<float> misfits(const std::vector<float>& x) const {
        const std::vector<Quadratic> field = fit_->fit(x);
        std::vector<float> misfit(receivers_.size());
        for (std::size_t r = 0; r < misfit.size(); ++r)
            misfit[r] = std::abs(mean_of(field[r][0]) - (x[3 * r] + x[3 * r + 1] + x[3 * r + 2]) / 3);
        return misfit;
    }

    [[nodiscard]] std::vector<C3f> at_points(const std::vector<float>& x) const {
        std::vector<C3f> irradiance(surface_.cloud.size());
        const std::vector<Quadratic> field = fit_->fit(x);
        std::vector<bool> known(surface_.set.patches.size());
        for (std::size_t p = 0; p < known.size(); ++p)
            known[p] = !surface_.set.patches[p].flat && !receivers_[center_of_[p]].buried;
        const CurvedLight curved(surface_, vector_irradiance(x), known);
        tbb::parallel_for(std::size_t{0}, surface_.tiles.size(), [&](std::size_t t) {
            const Tile& tile = surface_.tiles[t];
            const Patch& patch = surface_.set.patches[tile.patch];
            for (std::uint32_t k = tile.first_point; k < tile.first_point + tile.point_count; ++k) {
                const std::uint32_t i = surface_.set.point_order[k];
                const V3f& position = surface_.cloud.positions[i];
                if (!patch.flat) {
                    irradiance[i] = curved.at(tile.patch, position, surface_.cloud.normals[i]);
                    continue;
                }
                const C3f value =
                    fit_->value_at(fit_->locate(grids_[grid_of_[tile.patch]], patch.to_plane(position), true), field);
                irradiance[i] = {std::max(value.x, 0.0F), std::max(value.y, 0.0F), std::max(value.z, 0.0F)};
            }
        });
        return irradiance;
    }

    /// All that the texels send out.
    [[nodiscard]] std::vector<C3f> radiosity(const std::vector<float>& x) const {
        std::vector<C3f> radiosity = reflected(x);
        for (std::size_t t = 0; t < radiosity.size(); ++t) radiosity[t] += first_radiosity_[t];
        return radiosity;
    }

    [[nodiscard]] std::vector<VectorIrradiance> vector_irradiance(const std::vector<float>& x) const {
        const std::vector<C3f> radiosity = this->radiosity(x);
        std::vector<VectorIrradiance> fields(surface_.set.patches.size());
        tbb::parallel_for(std::size_t{0}, fields.size(), [&](std::size_t p) {
            if (!surface_.set.patches[p].flat) fields[p] = field_of(center_of_[p], radiosity);
        });
        return fields;
    }

    [[nodiscard]] VectorIrradiance field_of(std::uint32_t r, const std::vector<C3f>& radiosity) const {
        const NormalFrame frame = frame_of(r);
        const DirectionSet directions = directions_.set(receivers_[r].direction_set);
        VectorIrradiance field{V3f(0), V3f(0), V3f(0)};
        for (std::size_t k = 0; k < directions.size(); ++k) {
            const std::uint32_t texel = hits_of(r)[k];
            if (texel == no_texel) continue;
            // Over the receiver's own normal every ray counts once; the bound keeps grazing ones from ruling.
            const V3f local = directions[k];
            const float rise = std::max(local.z, 0.1F);
            const V3f unit = frame.world_from_local({local.x / rise, local.y / rise, 1});
            for (int c = 0; c < 3; ++c)
                field.at(static_cast<std::size_t>(c)) +=
                    unit * (radiosity[texel][c] / static_cast<float>(fineness_.rays));
        }
        return field;
    }

    void measure_noise(const std::vector<float>& x, IndirectResult& result) const {
        const std::vector<C3f> radiosity = this->radiosity(x);
        std::vector<double> noise(receivers_.size());
        tbb::parallel_for(std::size_t{0}, receivers_.size(), [&](std::size_t r) {
            double difference = 0;
            const std::span<const std::uint32_t> hits = hits_of(r);
            for (std::size_t k = 0; k < hits.size(); ++k)
                if (hits[k] != no_texel)
                    difference += (k < hits.size() / 2 ? 1.0 : -1.0) * static_cast<double>(mean_of(radiosity[hits[k]]));
            noise[r] = std::abs(difference) / fineness_.rays;
        });
        if (noise.empty()) return;
        for (const double n : noise) result.noise_mean += n / static_cast<double>(noise.size());
        const auto p95 = noise.begin() + static_cast<std::ptrdiff_t>(noise.size() * 95 / 100);
        std::nth_element(noise.begin(), p95, noise.end());
        result.noise_p95 = *p95;
    }

    const Surface& surface_;
    const std::vector<C3f>& direct_;
    IndirectConfig config_;
    Fineness fineness_;
    GatherDirections directions_;
    Texels texels_;
    std::vector<C3f> albedo_;           ///< per texel
    std::vector<C3f> first_radiosity_;  ///< per texel: from direct light (and emission where the rays gather it)
    std::vector<FieldPlace> places_;    ///< per texel: of the receivers that light it
    std::vector<Receiver> receivers_;
    std::vector<ReceiverGrid> grids_;
    std::vector<std::uint32_t> grid_of_;    ///< per patch, of flat ones
    std::vector<std::uint32_t> center_of_;  ///< per patch, receiver of curved ones
    std::vector<std::uint32_t> hits_;       ///< texel per ray; no_texel where it escapes or meets a back
    std::unique_ptr<const LocalFit> fit_;
};

}  // namespace

IndirectResult indirect_light(const Surface& surface, const std::vector<C3f>& direct, const IndirectConfig& config,
                              const ProgressCallback& progress) {
    return Gatherer(surface, direct, config).run(progress);
}

}  // namespace vmap
