// SPDX-License-Identifier: GPL-3.0-or-later
#include "view.h"

#include <vmap/error.h>

#include <cmath>
#include <numbers>

namespace vmap::picture {
namespace {

using Imath::V3d;

bool is_finite(const Imath::M44d& m) {
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            if (!std::isfinite(m[row][column])) return false;
    return true;
}

}  // namespace

View::View(const Camera& camera, int width, int height, const V3d& origin)
    : width_(width), height_(height), orthographic_(camera.orthographic) {
    const Imath::M44d& m = camera.world_from_camera;
    if (!is_finite(m)) throw UsageError("camera: its frame is not finite");
    // A camera's scale has no meaning: only its directions count.
    backward_ = V3d(m[2][0], m[2][1], m[2][2]).normalized();
    right_ = V3d(m[1][0], m[1][1], m[1][2]).cross(backward_).normalized();
    up_ = backward_.cross(right_);
    eye_ = V3d(m[3][0], m[3][1], m[3][2]) - origin;
    if (!(up_.length() > 0.5)) throw UsageError("camera: its frame is flat, expected three directions");
    if (orthographic_) {
        if (!(camera.half_height > 0) || !std::isfinite(camera.half_height))
            throw UsageError("camera: its half height is not positive");
        scale_ = 0.5 * height / camera.half_height;
    } else {
        if (!(camera.vertical_fov > 0) || !(camera.vertical_fov < std::numbers::pi))
            throw UsageError("camera: its vertical angle is outside (0, pi)");
        scale_ = 0.5 * height / std::tan(camera.vertical_fov / 2);
    }
}

Nearness View::nearness(const V3d& position, const V3d& normal) const {
    const V3d n(normal.dot(right_), normal.dot(up_), normal.dot(backward_));
    const double distance = normal.dot(position - eye_);
    // The plane is n.p = distance. In perspective p = depth * (right, up, -1); else p = (right, up, -depth).
    const double divisor = orthographic_ ? n.z : distance;
    if (divisor == 0) return {};
    Nearness result;
    if (orthographic_) {
        result.per_x = -n.x / (n.z * scale_);
        result.per_y = n.y / (n.z * scale_);
        result.constant = distance / n.z;
    } else {
        result.per_x = n.x / (distance * scale_);
        result.per_y = -n.y / (distance * scale_);
        result.constant = -n.z / distance;
    }
    result.constant -= 0.5 * (result.per_x * width_ + result.per_y * height_);
    return result;
}

}  // namespace vmap::picture
