// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud_normals.h"

#include "plane_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vmap {
namespace {

using Imath::V3d;
using Imath::V3f;

constexpr std::size_t fewest_neighbours = 12;
constexpr std::size_t most_neighbours = 48;
/// Points that are this share of the spacing off the surface need more than the fewest neighbours.
constexpr double small_noise = 0.06;
/// Up to this share of the spacing curvature is told from noise, and the normal is that of a quadric.
constexpr double little_noise = 0.03;
/// Below this share of the spacing noise is not told from rounding.
constexpr double least_noise = 0.01;

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Planes about all points, and how far the points are from quadrics.
struct LocalFits {
    std::vector<FittedPlane> planes;
    std::vector<double> deviations;
    std::vector<V3d> curved_normals;  ///< of the quadrics
    std::vector<bool> at_crease;      ///< the plane is that of one side
    double noise = 0;
};

class Estimator {
public:
    Estimator(std::span<const V3f> positions, const Neighbours& neighbours, double spacing, const Watch& watch)
        : positions_(positions), neighbours_(neighbours), spacing_(spacing), watch_(watch) {}

    NormalEstimate run() {
        NormalEstimate estimate;
        estimate.neighbours = std::min(fewest_neighbours, neighbours_.per_point());
        LocalFits fits = fit_all(estimate.neighbours);
        if (fits.noise > small_noise * spacing_) {
            // The tilt of a plane falls with the square of the neighbours' number.
            const double ratio = fits.noise / (small_noise * spacing_);
            const double wanted = static_cast<double>(fewest_neighbours) * std::min(ratio, 4.0);
            estimate.neighbours =
                std::min({static_cast<std::size_t>(wanted), most_neighbours, neighbours_.per_point()});
            fits = fit_all(estimate.neighbours);
        }
        estimate.noise = fits.noise;
        // Points that found a side lend their plane to those that found none.
        for (int round = 0; round < 2; ++round) estimate.creases += settle_creases(fits, estimate.neighbours);
        estimate.normals.reserve(positions_.size());
        const bool exact = fits.noise < little_noise * spacing_;
        for (std::size_t i = 0; i < positions_.size(); ++i)
            estimate.normals.emplace_back(exact && !fits.at_crease[i] ? fits.curved_normals[i] : fits.planes[i].normal);
        return estimate;
    }

private:
    [[nodiscard]] V3d at(std::uint32_t i) const { return V3d(positions_[i]); }

    [[nodiscard]] std::vector<V3d> around(std::size_t i, std::size_t count) const {
        std::vector<V3d> points;
        points.reserve(count + 1);
        points.push_back(at(static_cast<std::uint32_t>(i)));
        for (const std::uint32_t j : neighbours_.of(i, count)) points.push_back(at(j));
        return points;
    }

    [[nodiscard]] LocalFits fit_all(std::size_t count) const {
        LocalFits fits;
        fits.planes.resize(positions_.size());
        fits.deviations.resize(positions_.size());
        fits.curved_normals.resize(positions_.size());
        fits.at_crease.resize(positions_.size());
        for_each_point(positions_.size(), watch_, [&](std::size_t i) {
            const std::vector<V3d> points = around(i, count);
            fits.planes[i] = fit_plane(points);
            const FittedQuadric quadric = fit_quadric(points, fits.planes[i]);
            fits.deviations[i] = quadric.deviation;
            fits.curved_normals[i] = quadric.normal;
        });
        fits.noise = std::max(median(fits.deviations), least_noise * spacing_);
        return fits;
    }

    /// Returns how many points took another plane.
    std::size_t settle_creases(LocalFits& fits, std::size_t count) const {
        constexpr double crease = 1.5;  // deviation in units of the noise from which on a point is looked at
        std::vector<FittedPlane> settled = fits.planes;
        std::vector<char> changed(positions_.size());
        for_each_point(positions_.size(), watch_, [&](std::size_t i) {
            if (!(fits.deviations[i] > crease * fits.noise)) return;
            const std::uint32_t side = find_side(fits, i, 2 * count);
            if (side == none) return;
            std::vector<V3d> points;
            for (const V3d& point : around(i, 2 * count))
                if (distance(point, fits.planes[side]) < reach * fits.noise) points.push_back(point);
            if (points.size() < fewest_on_side) return;
            settled[i] = fit_plane(points);
            changed[i] = 1;
        });
        fits.planes = std::move(settled);
        for (std::size_t i = 0; i < changed.size(); ++i)
            if (changed[i] != 0) {
                fits.deviations[i] = 0;
                fits.at_crease[i] = true;
            }
        return static_cast<std::size_t>(std::count(changed.begin(), changed.end(), 1));
    }

    static double distance(const V3d& point, const FittedPlane& plane) {
        return std::abs((point - plane.center).dot(plane.normal));
    }

    /// The neighbour with a flat surrounding whose plane the point lies in best; none where there is no such.
    [[nodiscard]] std::uint32_t find_side(const LocalFits& fits, std::size_t i, std::size_t count) const {
        constexpr double flat = 1.6;  // deviation from its own plane in units of the noise up to which a point is flat
        std::uint32_t best = none;
        double least_cost = std::numeric_limits<double>::infinity();
        for (const std::uint32_t j : neighbours_.of(i, count)) {
            const FittedPlane& plane = fits.planes[j];
            const double off = distance(at(static_cast<std::uint32_t>(i)), plane) / fits.noise;
            const double unflat = plane.deviation / fits.noise;
            if (off > reach || unflat > flat) continue;
            const double cost = off * off / (reach * reach) + unflat * unflat;
            if (cost < least_cost) {
                least_cost = cost;
                best = j;
            }
        }
        return best;
    }

    static constexpr std::uint32_t none = 0xFFFFFFFF;
    static constexpr double reach = 2.5;  ///< distance in units of the noise up to which a point lies in a plane
    static constexpr std::size_t fewest_on_side = 5;

    std::span<const V3f> positions_;
    const Neighbours& neighbours_;
    double spacing_;
    const Watch& watch_;
};

}  // namespace

NormalEstimate estimate_normals(std::span<const V3f> positions, const Neighbours& neighbours, double spacing,
                                const Watch& watch) {
    return Estimator(positions, neighbours, spacing, watch).run();
}

}  // namespace vmap
