// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Points for the reference on the surface of a scene.
#pragma once

#include <reference/reference_tracer.h>
#include <vmap/surface_shading.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace vmap::test {

/// Where a face is in its scene.
struct Face {
    std::size_t instance;
    std::size_t triangle;
    const Material& material;
};

inline Face face_of(const Scene& scene, std::uint32_t face) {
    std::size_t triangle = face;
    std::size_t instance = 0;
    const auto count = [&] { return scene.meshes[scene.instances[instance].mesh].triangle_count(); };
    while (triangle >= count()) {
        triangle -= count();
        ++instance;
    }
    return {instance, triangle, scene.materials[scene.meshes[scene.instances[instance].mesh].material]};
}

/// Points spread evenly over the fronts of all faces, and the area that each stands for.
inline std::vector<reference::ReferencePoint> points_on(const Scene& scene, std::size_t count, double& area_each) {
    std::vector<double> areas;
    std::vector<SurfacePlace> places;
    double sum = 0;
    for (std::size_t i = 0; i < scene.instances.size(); ++i)
        for (std::size_t t = 0; t < scene.meshes[scene.instances[i].mesh].triangle_count(); ++t) {
            sum += world_area_normal(scene, i, t).length() / 2;
            areas.push_back(sum);
            places.push_back({.instance = i, .triangle = t});
        }
    area_each = sum / static_cast<double>(count);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform;
    std::vector<reference::ReferencePoint> points;
    points.reserve(count);
    for (std::size_t k = 0; k < count; ++k) {
        const double at = (static_cast<double>(k) + uniform(random)) * area_each;
        const auto face =
            std::min(static_cast<std::size_t>(std::lower_bound(areas.begin(), areas.end(), at) - areas.begin()),
                     areas.size() - 1);
        const auto [instance, triangle] = std::pair(places[face].instance, places[face].triangle);
        const auto [a, b, c] = world_triangle(scene, instance, triangle);
        const double root = std::sqrt(uniform(random));
        const double v = uniform(random);
        points.push_back({.position = a * (1 - root) + b * (root * (1 - v)) + c * (root * v),
                          .normal = world_area_normal(scene, instance, triangle).normalized(),
                          .face = static_cast<std::uint32_t>(face)});
    }
    return points;
}

}  // namespace vmap::test
