// SPDX-License-Identifier: GPL-3.0-or-later
#include <reference/emitters.h>

#include <algorithm>
#include <cmath>

namespace vmap::reference {
namespace {

using Imath::V3d;

double area_of(const std::array<V3d, 3>& triangle) {
    return (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).length() / 2;
}

double largest(const Imath::C3f& color) {
    return std::max({color.x, color.y, color.z});
}

/// About what a triangle sends out. Never zero where its material emits: a texture may be dark in the middle only.
double power_of(const RayScene& scene, std::uint32_t face) {
    SurfacePlace middle = scene.place(face, V3d(1.0 / 3));
    const Material& material = scene.shading().material(middle);
    if (!material.emits()) return 0;
    const double area = area_of(scene.triangle(face));
    middle.width = std::sqrt(area);
    return area * (0.9 * largest(scene.shading().emission(middle)) + 0.1 * largest(material.emission));
}

}  // namespace

Emitters::Emitters(const RayScene& scene) : scene_(&scene) {
    double sum = 0;
    for (std::uint32_t face = 0; face < scene.face_count(); ++face) {
        const double power = power_of(scene, face);
        if (!(power > 0)) continue;
        sum += power;
        faces_.push_back(face);
        cumulative_.push_back(sum);
    }
    if (faces_.empty()) return;
    density_of_face_.assign(scene.face_count(), 0.0F);
    double previous = 0;
    for (std::size_t i = 0; i < faces_.size(); ++i) {
        cumulative_[i] /= sum;
        density_of_face_[faces_[i]] =
            static_cast<float>((cumulative_[i] - previous) / area_of(scene.triangle(faces_[i])));
        previous = cumulative_[i];
    }
}

EmitterSample Emitters::choose(const Imath::V2d& sample) const {
    const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), sample.x);
    const auto index = std::min(static_cast<std::size_t>(found - cumulative_.begin()), faces_.size() - 1);
    const double below = index == 0 ? 0 : cumulative_[index - 1];
    const double rest = std::clamp((sample.x - below) / (cumulative_[index] - below), 0.0, 1.0);

    // What is left of the first number after the choice serves again: strata stay strata.
    const double root = std::sqrt(rest);
    const V3d barycentric(1 - root, root * (1 - sample.y), root * sample.y);
    const std::uint32_t face = faces_[index];
    const auto [a, b, c] = scene_->triangle(face);
    return {.face = face,
            .place = scene_->place(face, barycentric),
            .position = a * barycentric.x + b * barycentric.y + c * barycentric.z,
            .density = density_of_face_[face]};
}

}  // namespace vmap::reference
