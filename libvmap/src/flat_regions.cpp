// SPDX-License-Identifier: Apache-2.0
#include "flat_regions.h"

#include <Imath/ImathBox.h>
#include <Imath/ImathMatrixAlgo.h>

#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace vmap {
namespace {

using Imath::V3d;
using Imath::V3f;

constexpr std::size_t least_cell_points = 16;  ///< smaller cells are not cut further
constexpr std::size_t least_plane_points = 6;  ///< three make a plane; some more make sure of it
constexpr std::size_t parallel_points = 8192;  ///< smaller cells are cut by the thread that has them
constexpr double normal_tolerance = 2e-3;      ///< radians
constexpr float far_apart = 1;                 ///< range of a component of the normals that one cell does not have

/// Sums over the points of a cell, relative to an anchor near them so that nothing cancels.
struct Moments {
    double count = 0;
    V3d anchor{0, 0, 0};
    V3d sum{0, 0, 0};
    Imath::M33d products{0.0};
    V3d normals{0, 0, 0};

    [[nodiscard]] V3d center() const { return anchor + sum / count; }

    [[nodiscard]] Imath::M33d covariance() const {
        const V3d mean = sum / count;
        Imath::M33d c;
        for (int i = 0; i < 3; ++i)
            for (int k = 0; k < 3; ++k) c[i][k] = products[i][k] / count - mean[i] * mean[k];
        return c;
    }
};

Moments moments_of(const PointCloud& cloud, std::span<const std::uint32_t> points) {
    Moments m;
    m.anchor = V3d(cloud.positions[points[0]]);
    m.count = static_cast<double>(points.size());
    for (const std::uint32_t i : points) {
        const V3d p = V3d(cloud.positions[i]) - m.anchor;
        m.sum += p;
        m.normals += V3d(cloud.normals[i]);
        for (int a = 0; a < 3; ++a)
            for (int b = a; b < 3; ++b) m.products[a][b] += p[a] * p[b];
    }
    for (int a = 1; a < 3; ++a)
        for (int b = 0; b < a; ++b) m.products[a][b] = m.products[b][a];
    return m;
}

/// A cell whose points lie on one plane.
struct Seed {
    V3d center;
    V3d normal;
    Imath::M33d covariance;
    std::vector<std::uint32_t> points;

    /// Root mean square distance of the points to a plane.
    [[nodiscard]] double distance_to(const V3d& on_plane, const V3d& plane_normal) const {
        const double offset = plane_normal.dot(center - on_plane);
        const double spread = plane_normal.dot(plane_normal * covariance);
        return std::sqrt(std::max(spread, 0.0) + offset * offset);
    }
};

class SeedFinder {
public:
    SeedFinder(const PointCloud& cloud, double tolerance) : cloud_(cloud), tolerance_(tolerance) {}

    struct Found {
        std::vector<Seed> seeds;
        std::vector<std::uint32_t> rest;
    };

    Found find(std::span<std::uint32_t> points) const {
        Found found;
        if (points.empty()) return found;
        if (points.size() >= least_plane_points && add_if_flat(points, found)) return found;
        if (points.size() <= least_cell_points) {
            found.rest.assign(points.begin(), points.end());
            return found;
        }
        const std::size_t middle = halve(points);
        Found right;
        if (points.size() > parallel_points) {
            tbb::task_group group;
            group.run([&] { found = find(points.first(middle)); });
            right = find(points.subspan(middle));
            group.wait();
        } else {
            found = find(points.first(middle));
            right = find(points.subspan(middle));
        }
        found.seeds.insert(found.seeds.end(), std::make_move_iterator(right.seeds.begin()),
                           std::make_move_iterator(right.seeds.end()));
        found.rest.insert(found.rest.end(), right.rest.begin(), right.rest.end());
        return found;
    }

private:
    bool add_if_flat(std::span<const std::uint32_t> points, Found& found) const {
        // A few points far apart tell most cells that are not flat.
        const V3f probe = cloud_.normals[points[0]];
        for (std::size_t i = 1; i <= 8; ++i)
            if (cloud_.normals[points[(points.size() - 1) * i / 8]].dot(probe) < 1 - 2 * normal_tolerance) return false;

        const Moments m = moments_of(cloud_, points);
        if (m.normals.length() < m.count * (1 - normal_tolerance * normal_tolerance)) return false;
        Imath::M33d covariance = m.covariance();
        const V3d mean_normal = m.normals.normalized();
        Imath::M33d work = covariance;
        V3d values;
        Imath::M33d vectors;
        Imath::jacobiEigenSolver(work, values, vectors);
        std::array<int, 3> by_size{0, 1, 2};
        std::sort(by_size.begin(), by_size.end(), [&](int a, int b) { return values[a] < values[b]; });
        V3d normal(vectors[0][by_size[0]], vectors[1][by_size[0]], vectors[2][by_size[0]]);
        if (normal.dot(mean_normal) < 0) normal = -normal;
        // Points on a line leave the plane open; their normals decide.
        const bool line = values[by_size[1]] < 16 * tolerance_ * tolerance_;
        if (line) normal = mean_normal;
        if (normal.dot(mean_normal) < 1 - normal_tolerance * normal_tolerance) return false;
        Seed seed{m.center(), normal, covariance, {}};
        if (seed.distance_to(seed.center, normal) > tolerance_) return false;
        seed.points.assign(points.begin(), points.end());
        found.seeds.push_back(std::move(seed));
        return true;
    }

    /// Cuts where normals lie far apart, so that the two sides of a sheet part; else at the middle of the longest side
    /// of the bounding box.
    std::size_t halve(std::span<std::uint32_t> points) const {
        Imath::Box3f box;
        Imath::Box3f normals;
        for (const std::uint32_t i : points) {
            box.extendBy(cloud_.positions[i]);
            normals.extendBy(cloud_.normals[i]);
        }
        const int turn = static_cast<int>(normals.majorAxis());
        const bool by_normal = normals.size()[turn] > far_apart;
        const std::vector<V3f>& values = by_normal ? cloud_.normals : cloud_.positions;
        const int axis = by_normal ? turn : static_cast<int>(box.majorAxis());
        const float at = (by_normal ? normals : box).center()[axis];
        const auto middle =
            std::partition(points.begin(), points.end(), [&](std::uint32_t i) { return values[i][axis] < at; });
        const auto count = static_cast<std::size_t>(middle - points.begin());
        return count == 0 || count == points.size() ? points.size() / 2 : count;
    }

    const PointCloud& cloud_;
    double tolerance_;
};

struct Plane {
    FlatRegion region;
    Imath::Box3f bounds;
};

std::vector<Plane> merge(const PointCloud& cloud, std::vector<Seed> seeds, double tolerance) {
    std::stable_sort(seeds.begin(), seeds.end(),
                     [](const Seed& a, const Seed& b) { return a.points.size() > b.points.size(); });
    std::vector<Plane> planes;
    for (Seed& seed : seeds) {
        const auto fits = [&](const Plane& plane) {
            return seed.normal.dot(plane.region.normal) > 1 - 2 * normal_tolerance * normal_tolerance &&
                   seed.distance_to(plane.region.center, plane.region.normal) <= 2 * tolerance;
        };
        auto plane = std::find_if(planes.begin(), planes.end(), fits);
        if (plane == planes.end()) {
            planes.push_back({{seed.center, seed.normal, {}}, {}});
            plane = std::prev(planes.end());
        }
        for (const std::uint32_t i : seed.points) plane->bounds.extendBy(cloud.positions[i]);
        plane->region.points.insert(plane->region.points.end(), seed.points.begin(), seed.points.end());
    }
    return planes;
}

}  // namespace

FlatRegions find_flat_regions(const PointCloud& cloud, std::span<std::uint32_t> points, double spacing) {
    FlatRegions result;
    if (points.empty()) return result;
    Imath::Box3f box;
    for (const std::uint32_t i : points) box.extendBy(cloud.positions[i]);
    const double largest = std::max(box.max.length(), box.min.length());
    const double tolerance = std::max(1e-3 * spacing, 4e-7 * largest);

    SeedFinder::Found found = SeedFinder(cloud, tolerance).find(points);
    std::vector<Plane> planes = merge(cloud, std::move(found.seeds), tolerance);
    const V3f reach(static_cast<float>(4 * spacing));
    for (Plane& plane : planes) {
        plane.bounds.min -= reach;
        plane.bounds.max += reach;
    }

    // Points of cells that an edge runs through join the plane they lie on.
    std::vector<std::uint32_t> plane_of(found.rest.size());
    tbb::parallel_for(std::size_t{0}, found.rest.size(), [&](std::size_t k) {
        const V3f& p = cloud.positions[found.rest[k]];
        const V3d n(cloud.normals[found.rest[k]]);
        plane_of[k] = static_cast<std::uint32_t>(planes.size());
        double nearest = 3 * tolerance;
        for (std::size_t i = 0; i < planes.size(); ++i) {
            if (!planes[i].bounds.intersects(p)) continue;
            const FlatRegion& region = planes[i].region;
            const double distance = std::abs(region.normal.dot(V3d(p) - region.center));
            if (distance >= nearest || region.normal.dot(n) < 1 - 2 * normal_tolerance * normal_tolerance) continue;
            nearest = distance;
            plane_of[k] = static_cast<std::uint32_t>(i);
        }
    });
    for (std::size_t k = 0; k < found.rest.size(); ++k) {
        if (plane_of[k] < planes.size())
            planes[plane_of[k]].region.points.push_back(found.rest[k]);
        else
            result.rest.push_back(found.rest[k]);
    }
    for (Plane& plane : planes) result.regions.push_back(std::move(plane.region));
    return result;
}

}  // namespace vmap
