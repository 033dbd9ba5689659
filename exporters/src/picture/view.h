// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a camera makes of space: picture coordinates run from 0 to width and, downwards, from 0 to height; pixel (i, k)
/// covers [i, i + 1) x [k, k + 1).
#pragma once

#include <vmap/scene.h>

#include <Imath/ImathVec.h>

namespace vmap::picture {

/// A ray of sight, relative to the origin that the view was made for.
struct Sight {
    Imath::V3d from;
    Imath::V3d along;  ///< one unit deeper into the picture, so longer than 1 off the axis
};

/// A plane as the picture sees it: nearness = per_x * x + per_y * y + constant. Nearness is 1 / depth in perspective
/// and -depth otherwise; it is linear over the picture, and the larger one is in front.
struct Nearness {
    double per_x = 0;
    double per_y = 0;
    double constant = 0;

    [[nodiscard]] double at(double x, double y) const { return per_x * x + per_y * y + constant; }
};

class View {
public:
    /// - origin: world position that all other positions are relative to
    /// - throws UsageError for a camera without a view
    View(const Camera& camera, int width, int height, const Imath::V3d& origin);

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] bool orthographic() const { return orthographic_; }

    /// Right, up and backward of a position.
    [[nodiscard]] Imath::V3d camera_from(const Imath::V3d& position) const {
        const Imath::V3d p = position - eye_;
        return {p.dot(right_), p.dot(up_), p.dot(backward_)};
    }
    /// Picture coordinates and nearness of a place in the camera's frame; in perspective it must lie in front.
    [[nodiscard]] Imath::V2d picture_from(const Imath::V3d& in_camera) const {
        const double scale = orthographic_ ? scale_ : scale_ / -in_camera.z;
        return {0.5 * width_ + in_camera.x * scale, 0.5 * height_ - in_camera.y * scale};
    }
    [[nodiscard]] Sight sight(double x, double y) const {
        const double right = (x - 0.5 * width_) / scale_;
        const double up = (0.5 * height_ - y) / scale_;
        if (orthographic_) return {eye_ + right_ * right + up_ * up, -backward_};
        return {eye_, right_ * right + up_ * up - backward_};
    }
    /// Nearness of the plane through a position; zero throughout for a plane seen edge-on.
    [[nodiscard]] Nearness nearness(const Imath::V3d& position, const Imath::V3d& normal) const;

    /// Width of a pixel at a depth, world units.
    [[nodiscard]] double pixel_size(double depth) const { return orthographic_ ? 1 / scale_ : depth / scale_; }

    /// Whether the plane through a position turns its front to the camera.
    [[nodiscard]] bool sees_front(const Imath::V3d& position, const Imath::V3d& normal) const {
        return orthographic_ ? normal.dot(backward_) > 0 : normal.dot(eye_ - position) > 0;
    }

private:
    int width_;
    int height_;
    bool orthographic_;
    double scale_;  ///< pixels per unit of the picture plane: at depth 1 in perspective
    Imath::V3d eye_;
    Imath::V3d right_;
    Imath::V3d up_;
    Imath::V3d backward_;
};

}  // namespace vmap::picture
