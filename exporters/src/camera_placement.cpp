// SPDX-License-Identifier: GPL-3.0-or-later
#include <vmap/exporters/camera_placement.h>

#include <algorithm>
#include <cmath>

namespace vmap {
namespace {

using Imath::Box3d;
using Imath::M44d;
using Imath::V3d;

/// Room left around what is seen, as a share of the picture.
constexpr double margin = 0.03;

/// Frame of a camera that looks along -backward with +Y up in its picture.
M44d frame_of(const V3d& position, const V3d& backward) {
    const V3d right = V3d(0, 1, 0).cross(backward).normalized();
    const V3d up = backward.cross(right);
    return {right.x,    right.y,    right.z,    0, up.x,       up.y,       up.z,       0,
            backward.x, backward.y, backward.z, 0, position.x, position.y, position.z, 1};
}

V3d corner_of(const Box3d& box, unsigned corner) {
    return {(corner & 1U) != 0 ? box.max.x : box.min.x, (corner & 2U) != 0 ? box.max.y : box.min.y,
            (corner & 4U) != 0 ? box.max.z : box.min.z};
}

}  // namespace

Camera place_camera(const Box3d& bounds, double aspect) {
    const Box3d box = bounds.isEmpty() ? Box3d(V3d(0)) : bounds;
    const V3d backward = V3d(0.45, 0.4, 1).normalized();
    Camera camera;
    camera.name = "placed";
    camera.aspect = aspect;
    camera.vertical_fov = 0.7;

    // A corner fits when the camera stands so far behind it that its place across is within the half angle.
    const M44d turned = frame_of(V3d(0), backward);
    const double half_height = std::tan(camera.vertical_fov / 2) * (1 - margin);
    const double half_width = half_height * aspect;
    double distance = 0;
    for (unsigned corner = 0; corner < 8; ++corner) {
        const V3d p = corner_of(box, corner) - box.center();
        const V3d right(turned[0][0], turned[0][1], turned[0][2]);
        const V3d up(turned[1][0], turned[1][1], turned[1][2]);
        distance = std::max({distance, p.dot(backward) + std::abs(p.dot(right)) / half_width,
                             p.dot(backward) + std::abs(p.dot(up)) / half_height});
    }
    // Of a single place any distance shows it, as long as the coordinates can tell the two apart.
    const double least = 1e-9 * box.center().length();
    if (!(distance > least)) distance = std::max(1.0, least);
    camera.world_from_camera = frame_of(box.center() + backward * distance, backward);
    return camera;
}

Box3d bounds_of(const Scene& scene) {
    Box3d bounds;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        for (const std::uint32_t index : mesh.indices)
            bounds.extendBy(V3d(mesh.positions[index]) * instance.world_from_mesh);
    }
    return bounds;
}

Box3d bounds_of(const PointCloud& cloud) {
    Imath::Box3f relative;
    for (const Imath::V3f& p : cloud.positions) relative.extendBy(p);
    if (relative.isEmpty()) return {};
    return {cloud.origin + V3d(relative.min), cloud.origin + V3d(relative.max)};
}

}  // namespace vmap
