// SPDX-License-Identifier: GPL-3.0-or-later
#include "charts.h"

#include <algorithm>
#include <utility>

namespace vmap {
namespace {

using Imath::V3d;
using Imath::V3f;

constexpr std::uint32_t none = no_neighbour;

/// What a flat part needs to join a chart: cosines between the chart and the part's normals.
struct Limits {
    float smooth = 0.7F;
    float own = static_cast<float>(steepest_shown);
};

/// Grows charts over flat parts, which are never torn.
class ChartGrower {
public:
    ChartGrower(const LitSurface& surface, double spacing)
        : surface_(surface),
          spacing_(spacing),
          neighbours_(find_neighbours(surface, spacing)),
          flats_(find_flat_parts(surface, neighbours_)),
          smooth_(smooth_normals(surface, neighbours_, flats_, spacing)),
          chart_of_(flats_.size(), none) {
        cut_at_creases();
    }

    Charts grow() {
        const std::vector<std::uint32_t> order = by_area(flats_.areas);
        grow_from_largest(order);
        dissolve_small();
        widen(order, {.smooth = 0.55F});
        grow_from_largest(order);
        return take_result();
    }

private:
    /// Where smoothed normals differ too much there is an edge that matters to the points.
    void cut_at_creases() {
        for (std::size_t t = 0; t < neighbours_.size(); ++t)
            for (std::uint32_t& other : neighbours_[t])
                if (other != none && smooth_[t].dot(smooth_[other]) < smooth_cosine) other = none;
    }

    [[nodiscard]] const V3f& smooth_normal(std::uint32_t flat) const { return smooth_[flats_.triangles_of(flat)[0]]; }
    [[nodiscard]] const V3f& own_normal(std::uint32_t flat) const {
        return surface_.triangles[flats_.triangles_of(flat)[0]].normal;
    }

    [[nodiscard]] bool fits(std::uint32_t flat, const V3f& normal, const Limits& limits) const {
        // What is smaller than a point's share may be a fold in a rough surface.
        const bool is_small = flats_.areas[flat] < small_part * spacing_ * spacing_;
        return smooth_normal(flat).dot(normal) >= limits.smooth &&
               (is_small || own_normal(flat).dot(normal) >= limits.own);
    }

    /// Calls visit(flat part) for every part next to this one, some of them several times.
    template <class Visit>
    void for_each_next_to(std::uint32_t flat, const Visit& visit) const {
        for (const std::uint32_t t : flats_.triangles_of(flat))
            for (const std::uint32_t other : neighbours_[t])
                if (other != none) visit(flats_.of[other]);
    }

    /// Takes in all that fits and hangs together with the members.
    void spread(std::uint32_t chart, std::vector<std::uint32_t>& members, const Limits& limits) {
        for (std::size_t next = 0; next < members.size(); ++next)
            for_each_next_to(members[next], [&](std::uint32_t flat) {
                if (chart_of_[flat] != none || !fits(flat, normals_[chart], limits)) return;
                chart_of_[flat] = chart;
                members.push_back(flat);
            });
    }

    void grow_from_largest(const std::vector<std::uint32_t>& order) {
        std::vector<std::uint32_t> members;
        for (const std::uint32_t seed : order) {
            if (chart_of_[seed] != none) continue;
            const auto chart = static_cast<std::uint32_t>(normals_.size());
            chart_of_[seed] = chart;
            const bool is_fold = own_normal(seed).dot(smooth_normal(seed)) < Limits{}.own;
            normals_.push_back(is_fold ? own_normal(seed) : smooth_normal(seed));
            members.assign(1, seed);
            spread(chart, members, {});
        }
    }

    /// Small charts give their parts away, unless one of them is large itself.
    void dissolve_small() {
        constexpr double small = 100;  // points
        constexpr double large_flat = 8;
        std::vector<double> areas(normals_.size(), 0);
        for (std::uint32_t flat = 0; flat < flats_.size(); ++flat) {
            double& area = areas[chart_of_[flat]];
            area += flats_.areas[flat];
            if (flats_.areas[flat] >= large_flat * spacing_ * spacing_) area += small * spacing_ * spacing_;
        }
        for (std::uint32_t& chart : chart_of_)
            if (areas[chart] < small * spacing_ * spacing_) chart = none;
    }

    /// Charts take in, layer by layer, what is free and fits wider limits.
    void widen(const std::vector<std::uint32_t>& order, const Limits& limits) {
        std::vector<std::pair<std::uint32_t, std::uint32_t>> front;  // a free part, and a chart next to it
        const auto reach_out = [&](std::uint32_t flat) {
            for_each_next_to(flat, [&](std::uint32_t other) {
                if (chart_of_[other] == none && fits(other, normals_[chart_of_[flat]], limits))
                    front.emplace_back(other, chart_of_[flat]);
            });
        };
        for (const std::uint32_t flat : order)
            if (chart_of_[flat] != none) reach_out(flat);
        for (std::size_t next = 0; next < front.size(); ++next) {
            const auto [flat, chart] = front[next];
            if (chart_of_[flat] != none) continue;
            chart_of_[flat] = chart;
            reach_out(flat);
        }
    }

    /// Numbers the charts that are left and measures them.
    Charts take_result() {
        Charts result;
        std::vector<std::uint32_t> number(normals_.size(), none);
        result.chart_of.resize(surface_.triangles.size());
        for (std::uint32_t flat = 0; flat < flats_.size(); ++flat) {
            const std::uint32_t grown = chart_of_[flat];
            const V3d normal(normals_[grown]);
            if (number[grown] == none) {
                number[grown] = static_cast<std::uint32_t>(result.charts.size());
                result.charts.push_back({.normal = normal});
            }
            Chart& chart = result.charts[number[grown]];
            for (const std::uint32_t t : flats_.triangles_of(flat)) {
                result.chart_of[t] = number[grown];
                const double cosine = std::max(V3d(surface_.triangles[t].normal).dot(normal), steepest_shown);
                chart.min_cosine = std::min(chart.min_cosine, cosine);
            }
        }
        result.neighbours = std::move(neighbours_);
        result.flats = std::move(flats_);
        return result;
    }

    const LitSurface& surface_;
    double spacing_;
    Neighbours neighbours_;
    FlatParts flats_;
    std::vector<V3f> smooth_;              ///< normals of the triangles
    std::vector<std::uint32_t> chart_of_;  ///< of each flat part
    std::vector<V3f> normals_;             ///< of each chart
};

}  // namespace

Charts find_charts(const LitSurface& surface, double spacing) {
    return ChartGrower(surface, spacing).grow();
}

}  // namespace vmap
