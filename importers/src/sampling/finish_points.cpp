// SPDX-License-Identifier: GPL-3.0-or-later
#include "finish_points.h"

#include "stage_progress.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

namespace vmap {
namespace {

using Imath::C3f;
using Imath::V3d;
using Imath::V3f;

/// Where floats from the world's origin would cost more than a hundredth of the spacing, the scene's middle is better.
V3d origin_of(const LitSurface& surface, double spacing) {
    double farthest = 0;
    for (int axis = 0; axis < 3; ++axis) farthest = std::max(farthest, std::abs(surface.origin[axis]) + surface.extent);
    return farthest * 0x1p-24 > spacing / 100 ? surface.origin : V3d(0);
}

bool is_plain(const Scene& scene, const LitTriangle& triangle) {
    const Material& material = scene.materials[triangle.material()];
    return !material.base_color_texture && !material.metallic_texture && !material.emission_texture &&
           scene.meshes[scene.instances[triangle.instance].mesh].colors.empty();
}

/// Looks up points that come one after the other and often lie on the same triangle.
class Finisher {
public:
    Finisher(const LitSurface& surface, const SurfaceShading& shading, double spacing, SampleNormals normals,
             PointCloud& cloud)
        : surface_(surface), shading_(shading), spacing_(spacing), normals_(normals), cloud_(cloud) {}

    void finish(std::size_t i, const PlacedPoint& point) {
        const LitTriangle& triangle = surface_.triangles[point.triangle];
        if (number_ != point.triangle) begin_triangle(point.triangle);
        const double u = point.u * PlacedPoint::unit;
        const double v = point.v * PlacedPoint::unit;
        const auto& [a, b, c] = corners_;
        cloud_.positions[i] = V3f(a + (b - a) * u + (c - a) * v);
        cloud_.normals[i] = triangle.normal;
        cloud_.faces[i] = triangle.face;
        cloud_.materials[i] = triangle.material();

        if (!is_plain_ || normals_ == SampleNormals::shading) look_up(surface_.place(triangle, u, v, spacing_));
        if (normals_ == SampleNormals::shading) cloud_.normals[i] = V3f(triangle.is_back() ? -normal_ : normal_);
        cloud_.albedo[i] = albedo_;
        clamped_ += is_clamped_ ? 1 : 0;
        if (cloud_.emits()) cloud_.emission[i] = emission_;
    }

    [[nodiscard]] std::size_t clamped() const { return clamped_; }

private:
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    void begin_triangle(std::uint32_t number) {
        number_ = number;
        const LitTriangle& triangle = surface_.triangles[number];
        corners_ = surface_.corners(triangle);
        for (V3d& corner : corners_) corner += surface_.origin - cloud_.origin;
        is_plain_ = is_plain(*surface_.scene, triangle);
        if (is_plain_) look_up(surface_.place(triangle, 1.0 / 3, 1.0 / 3, spacing_));
    }

    void look_up(const SurfacePlace& place) {
        const C3f albedo = shading_.albedo(place);
        for (int k = 0; k < 3; ++k) albedo_[k] = std::clamp(albedo[k], 0.0F, 1.0F);
        is_clamped_ = albedo_ != albedo;
        if (cloud_.emits()) emission_ = shading_.emission(place);
        if (normals_ == SampleNormals::shading) normal_ = shading_.shading_normal(place);
    }

    const LitSurface& surface_;
    const SurfaceShading& shading_;
    double spacing_;
    SampleNormals normals_;
    PointCloud& cloud_;
    std::uint32_t number_ = none;  ///< of the triangle that the rest is about
    std::array<V3d, 3> corners_{V3d(0), V3d(0), V3d(0)};
    bool is_plain_ = false;  ///< the same albedo and emission all over it
    C3f albedo_{0};
    C3f emission_{0};
    V3d normal_{0, 0, 1};
    bool is_clamped_ = false;
    std::size_t clamped_ = 0;
};

}  // namespace

PointCloud finish_points(const LitSurface& surface, const SurfaceShading& shading, Placement placement, double spacing,
                         SampleNormals normals, const ProgressCallback& progress, std::vector<std::string>& warnings) {
    const std::size_t count = placement.points.size();
    PointCloud cloud;
    cloud.origin = origin_of(surface, spacing);
    cloud.positions.resize(count);
    cloud.normals.resize(count);
    cloud.areas = std::move(placement.areas);
    cloud.albedo.resize(count);
    cloud.faces.resize(count);
    cloud.materials.resize(count);
    if (std::ranges::any_of(surface.triangles, [&](const LitTriangle& triangle) {
            return surface.scene->materials[triangle.material()].emits();
        }))
        cloud.emission.resize(count);

    StageProgress stage(progress, 0.7, 1, count);
    std::atomic<std::size_t> clamped = 0;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 4096), [&](const auto& range) {
        Finisher finisher(surface, shading, spacing, normals, cloud);
        for (std::size_t i = range.begin(); i < range.end(); ++i) finisher.finish(i, placement.points[i]);
        clamped += finisher.clamped();
        stage.advance(range.size());
    });
    if (clamped > 0) warnings.push_back("albedo above 1 clamped at " + std::to_string(clamped) + " points");
    return cloud;
}

}  // namespace vmap
