// SPDX-License-Identifier: GPL-3.0-or-later
#include <crosscheck/surface_view.h>
#include <reference/ray_scene.h>

#include <algorithm>
#include <cmath>

namespace vmap::crosscheck {
namespace {

using Imath::V3d;

/// Through the middle of a pixel, unit.
V3d direction_through(const Camera& camera, int x, int y, int width, int height) {
    const double slope = std::tan(camera.vertical_fov / 2);
    const double right = ((x + 0.5) / width * 2 - 1) * slope * width / height;
    const double up = (1 - (y + 0.5) / height * 2) * slope;
    V3d direction;
    camera.world_from_camera.multDirMatrix(V3d(right, up, -1), direction);
    return direction.normalized();
}

Imath::C3f clamped(const Imath::C3f& albedo) {
    return {std::clamp(albedo.x, 0.0F, 1.0F), std::clamp(albedo.y, 0.0F, 1.0F), std::clamp(albedo.z, 0.0F, 1.0F)};
}

/// Whether an edge within a texture lies between two pixels: what the pixel shows then depends on how it is filtered.
bool differ_in_albedo(const SurfacePixel& a, const SurfacePixel& b) {
    constexpr float step = 0.02F;
    return std::abs(a.albedo.x - b.albedo.x) > step || std::abs(a.albedo.y - b.albedo.y) > step ||
           std::abs(a.albedo.z - b.albedo.z) > step;
}

/// Whether two neighbouring pixels see one smooth surface: each place lies near the other's tangent plane.
bool same_surface(const SurfacePixel& a, const SurfacePixel& b) {
    if (!a.lit_side || !b.lit_side) return a.lit_side == b.lit_side;
    if (a.point.normal.dot(b.point.normal) < 0.9) return false;
    const V3d way = b.point.position - a.point.position;
    return std::abs(way.dot(a.point.normal)) <= 0.5 * way.length() &&
           std::abs(way.dot(b.point.normal)) <= 0.5 * way.length();
}

}  // namespace

SurfaceView view_surface(const Scene& scene, const Camera& camera, int width, int height) {
    SurfaceView view{.width = width, .height = height, .pixels = {}};
    view.pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    std::vector<std::size_t> materials(view.pixels.size(), 0);
    const reference::RayScene rays(scene);
    const V3d eye = V3d(0) * camera.world_from_camera - rays.origin();
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto hit = rays.first_hit(eye, direction_through(camera, x, y, width, height));
            if (!hit || !hit->lit_side) continue;
            materials[view.index(x, y)] = scene.meshes[scene.instances[hit->place.instance].mesh].material;
            view.pixels[view.index(x, y)] = {
                .lit_side = true,
                .point = {.position = hit->position + rays.origin(), .normal = hit->normal, .face = hit->face},
                .albedo = clamped(rays.shading().albedo(hit->place)),
                .emission = rays.shading().emission(hit->place)};
        }
    const std::vector<bool> borders = near_difference(view, 1, [&](std::size_t a, std::size_t b) {
        return materials[a] != materials[b] || differ_in_albedo(view.pixels[a], view.pixels[b]) ||
               !same_surface(view.pixels[a], view.pixels[b]);
    });
    for (std::size_t i = 0; i < borders.size(); ++i) view.pixels[i].border = borders[i];
    return view;
}

}  // namespace vmap::crosscheck
