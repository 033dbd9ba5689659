// SPDX-License-Identifier: Apache-2.0
#include "indirect_light.h"

#include "gmres.h"
#include "receivers.h"
#include "sampling.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

namespace vmap {
namespace {

using Imath::C3f;
using Imath::V2f;
using Imath::V3f;

C3f product(const C3f& a, const C3f& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}
float mean_of(const C3f& c) {
    return (c.x + c.y + c.z) / 3;
}

/// Radiosity is kept on texels: a raster on every flat patch, one texel for a curved group.
struct TexelRaster {
    std::uint32_t first = 0;
    int width = 1;
    int height = 1;
    V2f low{0, 0};
    float size = 1;

    [[nodiscard]] std::uint32_t at(const V2f& place) const {
        const int x = std::clamp(static_cast<int>((place.x - low.x) / size), 0, width - 1);
        const int y = std::clamp(static_cast<int>((place.y - low.y) / size), 0, height - 1);
        return index(x, y);
    }
    [[nodiscard]] std::uint32_t index(int x, int y) const {
        return first + static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(width) +
               static_cast<std::uint32_t>(x);
    }
    [[nodiscard]] std::uint32_t count() const {
        return static_cast<std::uint32_t>(width) * static_cast<std::uint32_t>(height);
    }
    [[nodiscard]] V2f middle(int x, int y) const {
        return low + V2f((static_cast<float>(x) + 0.5F) * size, (static_cast<float>(y) + 0.5F) * size);
    }
};

struct Texel {
    C3f albedo{0, 0, 0};
    C3f radiosity{0, 0, 0};  ///< from direct light (and from emission where the rays gather it)
    Weights indirect;        ///< of the receivers that light it
};

class Gatherer {
public:
    Gatherer(const Surface& surface, const std::vector<C3f>& direct, const IndirectConfig& config)
        : surface_(surface), direct_(direct), config_(config) {
        const double ease = config.tolerance / 0.01;
        ray_count_ = static_cast<std::uint32_t>(std::clamp(256 / ease, 64.0, 4096.0));
        cell_size_ = surface.diagonal * static_cast<float>(std::clamp(std::sqrt(ease) / 24, 1.0 / 80, 1.0 / 10));
        cut_above_ = static_cast<float>(0.15 * std::clamp(std::sqrt(ease), 0.4, 3.0));
    }

    IndirectResult run(const ProgressCallback& progress) {
        place_receivers();
        make_rasters();
        trace();
        FixedPointResult solution = solve(1e-2);
        for (std::uint32_t level = 0; level < ReceiverGrid::max_level; ++level) {
            report_progress(progress, "indirect", 0.4 + 0.15 * level);
            if (!refine(level, solution.x)) break;
            trace();
            solution = solve(1e-2);
        }
        weigh_texels(true);
        report_progress(progress, "indirect", 0.85);
        solution = solve(std::min(1e-3, 0.05 * config_.tolerance));

        IndirectResult result;
        result.irradiance = at_points(solution.x);
        result.receivers = receivers_.size();
        result.rays = receivers_.size() * ray_count_;
        result.converged = solution.residual <= 1e-2 * std::max(config_.tolerance, 0.01);
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
                grids_.emplace_back(surface_, p, cell_size_, receivers_);
            } else {
                center_of_[p] = static_cast<std::uint32_t>(receivers_.size());
                receivers_.push_back({patch.center, patch.normal, p});
            }
        }
    }

    void make_rasters() {
        rasters_.resize(surface_.set.patches.size());
        std::uint32_t count = 0;
        for (std::size_t p = 0; p < rasters_.size(); ++p) {
            const Patch& patch = surface_.set.patches[p];
            TexelRaster& raster = rasters_[p];
            raster.first = count;
            if (patch.flat) {
                Imath::Box2f box;
                for (const V3f& v : surface_.set.outlines[p]) box.extendBy(patch.to_plane(v));
                raster.low = box.min;
                raster.size = std::max(1.2F * patch.spacing(), cell_size_ / 4);
                raster.width = std::max(1, static_cast<int>(std::ceil(box.size().x / raster.size)));
                raster.height = std::max(1, static_cast<int>(std::ceil(box.size().y / raster.size)));
            }
            count += raster.count();
        }
        texels_.resize(count);
        tbb::parallel_for(std::size_t{0}, rasters_.size(), [&](std::size_t p) { fill_raster(p); });
        weigh_texels(false);
    }

    /// Means over the points of every texel; a texel without points takes the mean of its patch's neighbours.
    void fill_raster(std::size_t p) {
        const Patch& patch = surface_.set.patches[p];
        const TexelRaster& raster = rasters_[p];
        std::vector<float> weight(raster.count(), 0.0F);
        for (const std::uint32_t i : surface_.set.points_of(patch)) {
            const std::uint32_t t = patch.flat ? raster.at(patch.to_plane(surface_.cloud.positions[i])) : raster.first;
            const C3f& albedo = surface_.cloud.albedo[i];
            const float area = surface_.cloud.areas[i];
            C3f radiosity = product(albedo, direct_[i]);
            if (config_.gather_emission && surface_.cloud.emits())
                radiosity += surface_.cloud.emission[i] * std::numbers::pi_v<float>;
            texels_[t].albedo += albedo * area;
            texels_[t].radiosity += radiosity * area;
            weight[t - raster.first] += area;
        }
        for (std::size_t k = 0; k < weight.size(); ++k)
            if (weight[k] > 0) {
                texels_[raster.first + k].albedo /= weight[k];
                texels_[raster.first + k].radiosity /= weight[k];
            }
        spread_into_gaps(raster, weight);
    }

    void spread_into_gaps(const TexelRaster& raster, std::vector<float>& weight) {
        const auto index = [&](int x, int y) { return std::size_t{raster.index(x, y) - raster.first}; };
        for (int round = 0; round < raster.width + raster.height; ++round) {
            std::vector<std::size_t> filled;
            bool gaps = false;
            for (int y = 0; y < raster.height; ++y)
                for (int x = 0; x < raster.width; ++x) {
                    if (weight[index(x, y)] > 0) continue;
                    gaps = true;
                    Texel sum;
                    float count = 0;
                    for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, raster.height - 1); ++ny)
                        for (int nx = std::max(x - 1, 0); nx <= std::min(x + 1, raster.width - 1); ++nx) {
                            if (!(weight[index(nx, ny)] > 0)) continue;
                            sum.albedo += texels_[raster.first + index(nx, ny)].albedo;
                            sum.radiosity += texels_[raster.first + index(nx, ny)].radiosity;
                            ++count;
                        }
                    if (!(count > 0)) continue;
                    texels_[raster.first + index(x, y)].albedo = sum.albedo / count;
                    texels_[raster.first + index(x, y)].radiosity = sum.radiosity / count;
                    filled.push_back(index(x, y));
                }
            for (const std::size_t k : filled) weight[k] = 1;
            if (!gaps) break;
        }
    }

    void weigh_texels(bool careful) {
        tbb::parallel_for(std::size_t{0}, rasters_.size(), [&](std::size_t p) {
            const Patch& patch = surface_.set.patches[p];
            const TexelRaster& raster = rasters_[p];
            for (int y = 0; y < raster.height; ++y)
                for (int x = 0; x < raster.width; ++x) {
                    Texel& texel = texels_[raster.index(x, y)];
                    texel.indirect = patch.flat ? weights_on_flat(p, raster.middle(x, y), careful)
                                                : Weights{{center_of_[p], 0, 0, 0}, {1, 0, 0, 0}};
                }
        });
    }

    /// Bilinear; where something stands on the cell only the corners that the place sees along the surface count.
    [[nodiscard]] Weights weights_on_flat(std::size_t p, const V2f& place, bool careful) const {
        auto [weights, cell] = grids_[grid_of_[p]].weights_at(place);
        if (!careful || !cell->contact) return weights;
        const Patch& patch = surface_.set.patches[p];
        const V3f lift = patch.normal * (8 * surface_.gather_offset(patch));
        const V3f from = patch.from_plane(place) + lift;
        std::array<Ray, 4> rays;
        std::array<std::uint8_t, 4> blocked{};
        for (std::size_t k = 0; k < 4; ++k)
            rays.at(k) = {from, receivers_[weights.receiver.at(k)].position + lift - from, 0, 1};
        surface_.bvh.any_hits(rays, blocked);
        float seen = 0;
        for (std::size_t k = 0; k < 4; ++k)
            if (blocked.at(k) == 0) seen += weights.weight.at(k);
        if (!(seen > 1e-4F)) return weights;
        for (std::size_t k = 0; k < 4; ++k)
            weights.weight.at(k) = blocked.at(k) == 0 ? weights.weight.at(k) / seen : 0.0F;
        return weights;
    }

    /// Frame whose z is the receiver's normal.
    struct Frame {
        V3f x;
        V3f y;
        V3f z;
        explicit Frame(const V3f& normal)
            : x(normal.cross(std::abs(normal.x) < 0.6F ? V3f(1, 0, 0) : V3f(0, 1, 0)).normalized()),
              y(normal.cross(x)),
              z(normal) {}
    };

    [[nodiscard]] V3f direction(const Frame& frame, std::size_t receiver, std::uint32_t ray) const {
        const Imath::V3d local = cosine_direction(shifted_r2(config_.seed * 0xD1B54A32D192ED03ULL + receiver, ray));
        return frame.x * static_cast<float>(local.x) + frame.y * static_cast<float>(local.y) +
               frame.z * static_cast<float>(local.z);
    }

    /// Rays of the receivers that have none yet.
    void trace() {
        const std::size_t first = hits_.size() / ray_count_;
        hits_.resize(receivers_.size() * ray_count_, no_texel);
        tbb::parallel_for(first, receivers_.size(), [&](std::size_t r) { trace_receiver(r); });
    }

    void trace_receiver(std::size_t r) {
        const Receiver& receiver = receivers_[r];
        const Patch& patch = surface_.set.patches[receiver.patch];
        const Frame frame(receiver.normal);
        const V3f origin = receiver.position + receiver.normal * surface_.gather_offset(patch);
        std::vector<Ray> rays(ray_count_);
        std::vector<RayHit> hits(ray_count_);
        for (std::uint32_t k = 0; k < ray_count_; ++k) rays[k] = {origin, direction(frame, r, k)};
        surface_.bvh.first_hits(rays, hits);
        for (std::uint32_t k = 0; k < ray_count_; ++k) {
            RayHit hit = hits[k];
            if (hit && !hit.front && !surface_.set.patches[hit.polygon].flat) {
                // The back of a group: a neighbour that pokes through the curve. Start clear of it.
                rays[k].origin =
                    receiver.position + receiver.normal * (2 * surface_.set.patches[hit.polygon].spacing());
                hit = surface_.bvh.first_hit(rays[k]);
            }
            if (!hit || !hit.front) continue;
            const Patch& met = surface_.set.patches[hit.polygon];
            const TexelRaster& raster = rasters_[hit.polygon];
            hits_[r * ray_count_ + k] =
                met.flat ? raster.at(met.to_plane(rays[k].origin + rays[k].direction * hit.t)) : raster.first;
        }
    }

    [[nodiscard]] std::vector<float> gather(const std::vector<C3f>& radiosity) const {
        std::vector<float> gathered(receivers_.size() * 3);
        tbb::parallel_for(std::size_t{0}, receivers_.size(), [&](std::size_t r) {
            C3f sum(0, 0, 0);
            for (std::uint32_t k = 0; k < ray_count_; ++k) {
                const std::uint32_t texel = hits_[r * ray_count_ + k];
                if (texel != no_texel) sum += radiosity[texel];
            }
            for (int c = 0; c < 3; ++c)
                gathered[3 * r + static_cast<std::size_t>(c)] = sum[c] / static_cast<float>(ray_count_);
        });
        return gathered;
    }

    [[nodiscard]] static C3f value_at(const Weights& weights, const std::vector<float>& x) {
        C3f value(0, 0, 0);
        for (std::size_t k = 0; k < 4; ++k) {
            const std::size_t r = std::size_t{3} * weights.receiver.at(k);
            value += C3f(x[r], x[r + 1], x[r + 2]) * weights.weight.at(k);
        }
        return value;
    }

    /// What the texels reflect of the indirect light alone.
    [[nodiscard]] std::vector<C3f> reflected(const std::vector<float>& x) const {
        std::vector<C3f> radiosity(texels_.size());
        tbb::parallel_for(std::size_t{0}, texels_.size(), [&](std::size_t t) {
            radiosity[t] = product(texels_[t].albedo, value_at(texels_[t].indirect, x));
        });
        return radiosity;
    }

    [[nodiscard]] FixedPointResult solve(double tolerance) const {
        std::vector<C3f> first(texels_.size());
        for (std::size_t t = 0; t < texels_.size(); ++t) first[t] = texels_[t].radiosity;
        return solve_fixed_point(
            gather(first), [&](const std::vector<float>& x) { return gather(reflected(x)); }, tolerance);
    }

    /// Cuts the cells of a level whose corners differ too much, or that something stands on.
    bool refine(std::uint32_t level, const std::vector<float>& x) {
        double sum = 0;
        for (const C3f& e : direct_) sum += static_cast<double>(mean_of(e));
        double indirect = 0;
        for (const float value : x) indirect += static_cast<double>(value);
        const double mean = sum / static_cast<double>(std::max<std::size_t>(direct_.size(), 1)) +
                            indirect / static_cast<double>(std::max<std::size_t>(x.size(), 1));
        const std::size_t before = receivers_.size();
        for (ReceiverGrid& grid : grids_) {
            const std::size_t count = grid.cells().size();
            for (std::size_t c = 0; c < count; ++c) {
                const ReceiverGrid::Cell& cell = grid.cells()[c];
                if (cell.level != level || cell.first_child != 0) continue;
                float low = std::numeric_limits<float>::max();
                float high = 0;
                for (const std::uint32_t r : cell.vertex) {
                    const float value = mean_of({x[3 * r], x[3 * r + 1], x[3 * r + 2]});
                    low = std::min(low, value);
                    high = std::max(high, value);
                }
                if (cell.contact || high - low > cut_above_ * static_cast<float>(mean)) grid.cut(c, receivers_);
            }
        }
        weigh_texels(false);
        return receivers_.size() > before;
    }

    std::vector<C3f> at_points(const std::vector<float>& x) const {
        std::vector<C3f> irradiance(surface_.cloud.size());
        const CurvedLight curved(*this, x);
        tbb::parallel_for(std::size_t{0}, surface_.tiles.size(), [&](std::size_t t) {
            const Tile& tile = surface_.tiles[t];
            const Patch& patch = surface_.set.patches[tile.patch];
            for (std::uint32_t k = tile.first_point; k < tile.first_point + tile.point_count; ++k) {
                const std::uint32_t i = surface_.set.point_order[k];
                irradiance[i] =
                    patch.flat
                        ? value_at(weights_on_flat(tile.patch, patch.to_plane(surface_.cloud.positions[i]), true), x)
                        : curved.at(tile.patch, surface_.cloud.positions[i], surface_.cloud.normals[i]);
            }
        });
        return irradiance;
    }

    /// Light on curved surface: every group knows its irradiance as a function of the normal (the vector irradiance of
    /// its rays), and neighbouring groups of like normal are blended.
    class CurvedLight {
    public:
        CurvedLight(const Gatherer& gatherer, const std::vector<float>& x) : gatherer_(gatherer) {
            const Surface& surface = gatherer.surface_;
            std::vector<C3f> radiosity = gatherer.reflected(x);
            for (std::size_t t = 0; t < radiosity.size(); ++t) radiosity[t] += gatherer.texels_[t].radiosity;
            fields_.resize(surface.set.patches.size());
            tbb::parallel_for(std::size_t{0}, fields_.size(), [&](std::size_t p) {
                if (!surface.set.patches[p].flat) fields_[p] = field_of(p, radiosity);
            });
            for (const Patch& patch : surface.set.patches)
                if (!patch.flat) reach_ = std::max(reach_, 1.5F * std::sqrt(patch.area));
            for (std::uint32_t p = 0; p < surface.set.patches.size(); ++p)
                if (!surface.set.patches[p].flat) cells_[key(surface.set.patches[p].center, {0, 0, 0})].push_back(p);
        }

        [[nodiscard]] C3f at(std::uint32_t own, const V3f& position, const V3f& normal) const {
            const Surface& surface = gatherer_.surface_;
            C3f sum(0, 0, 0);
            float total = 0;
            const float reach = 1.5F * std::sqrt(surface.set.patches[own].area);
            for (int dx = -1; dx <= 1; ++dx)
                for (int dy = -1; dy <= 1; ++dy)
                    for (int dz = -1; dz <= 1; ++dz) {
                        const auto cell = cells_.find(key(position, {dx, dy, dz}));
                        if (cell == cells_.end()) continue;
                        for (const std::uint32_t p : cell->second) {
                            const Patch& patch = surface.set.patches[p];
                            const float near = 1 - (patch.center - position).length2() / (reach * reach);
                            const float alike = near - (1 - patch.normal.dot(normal)) / 0.1F;
                            if (alike <= 0) continue;
                            sum += value(p, normal) * (alike * alike);
                            total += alike * alike;
                        }
                    }
            return total > 0 ? sum / total : value(own, normal);
        }

    private:
        using Field = std::array<V3f, 3>;  ///< per channel: irradiance over n is field.dot(n)

        [[nodiscard]] C3f value(std::uint32_t p, const V3f& normal) const {
            const Field& field = fields_[p];
            return {std::max(field[0].dot(normal), 0.0F), std::max(field[1].dot(normal), 0.0F),
                    std::max(field[2].dot(normal), 0.0F)};
        }

        [[nodiscard]] Field field_of(std::size_t p, const std::vector<C3f>& radiosity) const {
            const std::uint32_t r = gatherer_.center_of_[p];
            const Frame frame(gatherer_.receivers_[r].normal);
            Field field{V3f(0), V3f(0), V3f(0)};
            for (std::uint32_t k = 0; k < gatherer_.ray_count_; ++k) {
                const std::uint32_t texel = gatherer_.hits_[std::size_t{r} * gatherer_.ray_count_ + k];
                if (texel == no_texel) continue;
                const V3f way = gatherer_.direction(frame, r, k);
                // Over the receiver's own normal every ray counts once; the bound keeps grazing ones from ruling.
                const float cosine = way.dot(frame.z);
                const V3f unit = frame.z + (way - frame.z * cosine) / std::max(cosine, 0.1F);
                for (int c = 0; c < 3; ++c)
                    field.at(static_cast<std::size_t>(c)) +=
                        unit * (radiosity[texel][c] / static_cast<float>(gatherer_.ray_count_));
            }
            return field;
        }

        [[nodiscard]] std::uint64_t key(const V3f& p, const Imath::V3i& step) const {
            std::uint64_t hash = 0;
            for (int axis = 0; axis < 3; ++axis) {
                const auto cell = static_cast<std::int64_t>(std::floor(p[axis] / reach_)) + step[axis];
                hash = hash64(hash ^ static_cast<std::uint64_t>(cell));
            }
            return hash;
        }

        const Gatherer& gatherer_;
        std::vector<Field> fields_;
        float reach_ = 1e-30F;
        std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
    };

    void measure_noise(const std::vector<float>& x, IndirectResult& result) const {
        std::vector<C3f> radiosity = reflected(x);
        for (std::size_t t = 0; t < radiosity.size(); ++t) radiosity[t] += texels_[t].radiosity;
        std::vector<double> noise(receivers_.size());
        tbb::parallel_for(std::size_t{0}, receivers_.size(), [&](std::size_t r) {
            double difference = 0;
            for (std::uint32_t k = 0; k < ray_count_; ++k) {
                const std::uint32_t texel = hits_[r * ray_count_ + k];
                if (texel == no_texel) continue;
                difference += (k < ray_count_ / 2 ? 1.0 : -1.0) * static_cast<double>(mean_of(radiosity[texel]));
            }
            noise[r] = std::abs(difference) / ray_count_;
        });
        if (noise.empty()) return;
        for (const double n : noise) result.noise_mean += n / static_cast<double>(noise.size());
        const auto p95 = noise.begin() + static_cast<std::ptrdiff_t>(noise.size() * 95 / 100);
        std::nth_element(noise.begin(), p95, noise.end());
        result.noise_p95 = *p95;
    }

    static constexpr std::uint32_t no_texel = 0xFFFFFFFFU;

    const Surface& surface_;
    const std::vector<C3f>& direct_;
    IndirectConfig config_;
    std::uint32_t ray_count_ = 256;
    float cell_size_ = 1;
    float cut_above_ = 0.15F;
    std::vector<Receiver> receivers_;
    std::vector<ReceiverGrid> grids_;
    std::vector<std::uint32_t> grid_of_;    ///< per patch, of flat ones
    std::vector<std::uint32_t> center_of_;  ///< per patch, receiver of curved ones
    std::vector<TexelRaster> rasters_;
    std::vector<Texel> texels_;
    std::vector<std::uint32_t> hits_;  ///< texel per ray; no_texel where it escapes or meets a back
};

}  // namespace

IndirectResult indirect_light(const Surface& surface, const std::vector<C3f>& direct, const IndirectConfig& config,
                              const ProgressCallback& progress) {
    return Gatherer(surface, direct, config).run(progress);
}

}  // namespace vmap
