// SPDX-License-Identifier: GPL-3.0-or-later
#include <vmap/importers/prepare_cloud.h>

#include "../mesh/mesh_file.h"
#include "cloud_areas.h"
#include "cloud_normals.h"
#include "lit_side.h"
#include "neighbours.h"
#include "orient_normals.h"

#include <vmap/error.h>

#include <fmt/format.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <numeric>
#include <string_view>
#include <utility>

namespace vmap {
namespace {

using Imath::V3d;
using Imath::V3f;

/// Enough for both sides of a crease in noisy scans.
constexpr std::size_t neighbours_per_point = 32;

template <class T>
void keep_only(const std::vector<std::uint32_t>& kept, std::vector<T>& values) {
    if (values.empty()) return;
    std::vector<T> result;
    result.reserve(kept.size());
    for (const std::uint32_t i : kept) result.push_back(values[i]);
    values = std::move(result);
}

void keep_only(const std::vector<std::uint32_t>& kept, LitCloud& cloud) {
    keep_only(kept, cloud.points.positions);
    keep_only(kept, cloud.points.normals);
    keep_only(kept, cloud.points.areas);
    keep_only(kept, cloud.points.albedo);
    keep_only(kept, cloud.points.emission);
    keep_only(kept, cloud.points.faces);
    keep_only(kept, cloud.points.materials);
    keep_only(kept, cloud.irradiance);
}

/// The first of all points in each place, in their order.
std::vector<std::uint32_t> distinct_places(const std::vector<V3f>& positions) {
    std::vector<std::uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0U);
    // Adding 0 makes one zero of both.
    const auto key = [&](std::uint32_t i) {
        return std::array{positions[i].x + 0.0F, positions[i].y + 0.0F, positions[i].z + 0.0F};
    };
    tbb::parallel_sort(order.begin(), order.end(),
                       [&](std::uint32_t a, std::uint32_t b) { return std::pair(key(a), a) < std::pair(key(b), b); });
    order.erase(
        std::unique(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) == key(b); }),
        order.end());
    std::sort(order.begin(), order.end());
    return order;
}

void expect_a_surface(const std::vector<V3f>& positions) {
    if (positions.size() < 3)
        throw UnsupportedInput(fmt::format("points in {} place{}, expected 3 or more that are no line",
                                           positions.size(), positions.size() == 1 ? "" : "s"));
    const V3d first(positions.front());
    V3d longest(0);
    for (const V3f& position : positions)
        if ((V3d(position) - first).length2() > longest.length2()) longest = V3d(position) - first;
    const V3d along = longest.normalized();
    constexpr double least_width = 1e-6;
    const bool wide = std::any_of(positions.begin(), positions.end(), [&](const V3f& position) {
        return (V3d(position) - first).cross(along).length() > least_width * longest.length();
    });
    if (!wide)
        throw UnsupportedInput(fmt::format("all {} points lie on one line, expected a surface", positions.size()));
}

std::vector<double> local_spacings(const std::vector<V3f>& positions, const Neighbours& neighbours) {
    std::vector<double> spacings(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) spacings[i] = local_spacing(neighbours, positions, i);
    return spacings;
}

/// Points that are about as far from their neighbours as those are from theirs.
std::vector<std::uint32_t> without_outliers(const std::vector<double>& spacings, const Neighbours& neighbours) {
    constexpr double far = 3;
    constexpr std::size_t compared = 6;
    std::vector<std::uint32_t> kept;
    kept.reserve(spacings.size());
    for (std::uint32_t i = 0; i < spacings.size(); ++i) {
        std::vector<double> around;
        for (const std::uint32_t j : neighbours.of(i, compared)) around.push_back(spacings[j]);
        const auto middle = around.begin() + static_cast<std::ptrdiff_t>(around.size() / 2);
        std::nth_element(around.begin(), middle, around.end());
        if (spacings[i] <= far * *middle) kept.push_back(i);
    }
    return kept;
}

/// What was found about the sides, for the warning.
struct SideChoice {
    CloudSide side = CloudSide::outward;
    std::string_view reason;
};

class CloudPreparation {
public:
    CloudPreparation(LitCloud& cloud, const PrepareConfig& config, PrepareReport& report,
                     const ProgressCallback& progress)
        : cloud_(cloud), points_(cloud.points), config_(config), report_(report), progress_(progress) {}

    void run() {
        if (points_.areas.size() != points_.size() || !positive(points_.areas)) points_.areas.clear();
        const bool needs_surface = points_.normals.empty() || points_.areas.empty();
        if (needs_surface) complete_surface();
        if (points_.albedo.empty()) {
            points_.albedo.assign(points_.size(), Imath::C3f(default_albedo, default_albedo, default_albedo));
            warn(fmt::format("the points have no colours: albedo {}", default_albedo));
        }
        for (const float area : points_.areas) report_.area += static_cast<double>(area);
    }

private:
    static bool positive(const std::vector<float>& values) {
        return std::all_of(values.begin(), values.end(), [](float value) { return value > 0; });
    }

    /// Tells how much is done, roughly; long loops tell it again, so that they can be interrupted.
    void reach(double done) {
        const std::lock_guard lock(mutex_);
        done_ = done;
        report_progress(progress_, "prepare", done_);
    }

    void warn(std::string text) { report_.warnings.push_back(std::move(text)); }

    void complete_surface() {
        reach(0);
        const Neighbours neighbours = find_surface();
        reach(0.4);
        if (points_.normals.empty())
            estimate_oriented_normals(neighbours);
        else
            estimate_missing_areas(neighbours);
        reach(1);
    }

    /// Drops what is not on the surface.
    Neighbours find_surface() {
        const std::vector<std::uint32_t> distinct = distinct_places(points_.positions);
        report_.duplicates = points_.size() - distinct.size();
        if (report_.duplicates > 0) {
            keep_only(distinct, cloud_);
            warn(fmt::format("{} points are in the place of another one: dropped", report_.duplicates));
        }
        expect_a_surface(points_.positions);
        Neighbours neighbours = find_neighbours(points_.positions, neighbours_per_point, watch_);
        std::vector<double> spacings = local_spacings(points_.positions, neighbours);
        const std::vector<std::uint32_t> kept = without_outliers(spacings, neighbours);
        report_.outliers = points_.size() - kept.size();
        if (report_.outliers > 0) {
            keep_only(kept, cloud_);
            keep_only(kept, spacings);
            warn(fmt::format("{} points are far from all others: dropped as outliers", report_.outliers));
            expect_a_surface(points_.positions);
            neighbours = find_neighbours(points_.positions, neighbours_per_point, watch_);
        }
        report_.spacing = std::accumulate(spacings.begin(), spacings.end(), 0.0) / static_cast<double>(spacings.size());
        return neighbours;
    }

    void estimate_missing_areas(const Neighbours& neighbours) {
        if (!points_.areas.empty()) return;
        points_.areas = estimate_areas(points_.positions, points_.normals, neighbours, watch_);
        warn("the points have no areas: estimated from their distances");
    }

    void estimate_oriented_normals(const Neighbours& neighbours) {
        NormalEstimate estimate = estimate_normals(points_.positions, neighbours, report_.spacing, watch_);
        report_.noise = std::isfinite(estimate.noise) ? estimate.noise : 0;
        points_.normals = std::move(estimate.normals);
        reach(0.7);
        const CloudPieces pieces = make_normals_agree(points_.positions, neighbours, points_.normals);
        turn_pieces(points_.positions, pieces, CloudSide::outward, points_.normals);
        reach(0.8);
        estimate_missing_areas(neighbours);
        if (config_.viewpoint) {
            turn_to_viewpoint(points_.positions, *config_.viewpoint - points_.origin, points_.normals);
            warn("the points have no normals: estimated, towards the viewpoint");
            return;
        }
        const SideChoice choice = choose_side();
        if (choice.side != CloudSide::outward) turn_pieces(points_.positions, pieces, choice.side, points_.normals);
        warn(fmt::format("the points have no normals: estimated, {}", choice.reason));
    }

    [[nodiscard]] SideChoice choose_side() const {
        switch (config_.side) {
            case CloudSide::topmost:
                return {CloudSide::topmost, "the topmost ones upwards"};
            case CloudSide::inward:
                return {CloudSide::inward, "inward"};
            case CloudSide::outward:
                return {CloudSide::outward, "outward"};
            case CloudSide::automatic:
                break;
        }
        std::vector<LightSource> lights(config_.lights.begin(), config_.lights.end());
        for (LightSource& light : lights) light.position -= points_.origin;
        if (encloses_light(points_.positions, points_.normals, points_.areas, lights))
            return {CloudSide::inward, "inward, because the points surround a light"};
        if (looks_like_a_room(points_.positions))
            return {CloudSide::inward, "inward, because the points look like a room (--orient outward for an object)"};
        return {CloudSide::outward, "outward, as of an object (--orient inward for a room)"};
    }

    LitCloud& cloud_;
    PointCloud& points_;
    const PrepareConfig& config_;
    PrepareReport& report_;
    const ProgressCallback& progress_;
    std::mutex mutex_;
    double done_ = 0;
    Watch watch_ = [this] {
        const std::lock_guard lock(mutex_);
        report_progress(progress_, "prepare", done_);
    };
};

}  // namespace

bool is_complete(const PointCloud& cloud) {
    return cloud.normals.size() == cloud.size() && cloud.albedo.size() == cloud.size() &&
           cloud.areas.size() == cloud.size() &&
           std::all_of(cloud.areas.begin(), cloud.areas.end(), [](float area) { return area > 0; });
}

void prepare_cloud(LitCloud& cloud, const PrepareConfig& config, PrepareReport* report,
                   const ProgressCallback& progress) {
    PrepareReport unused;
    CloudPreparation(cloud, config, report != nullptr ? *report : unused, progress).run();
}

}  // namespace vmap
