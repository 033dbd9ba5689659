// SPDX-License-Identifier: GPL-3.0-or-later
#include "pov_frame.h"

#include "pov_text.h"

#include <vmap/exporters/output_info.h>

#include <cmath>

namespace vmap {
namespace {

using Imath::V3d;

V3d row_of(const Imath::M44d& m, int row) {
    return {m[row][0], m[row][1], m[row][2]};
}

double scale_for(double diameter) {
    constexpr double smallest = 1, largest = 1e4;
    if (!(diameter > 0) || (diameter >= smallest && diameter <= largest)) return 1;
    return std::pow(10.0, 1 - std::floor(std::log10(diameter)));
}

}  // namespace

PovFrame::PovFrame(const Imath::Box3d& world_bounds, UpAxis up) {
    const double world_diameter = world_bounds.isEmpty() ? 0 : world_bounds.size().length();
    scale = scale_for(world_diameter);
    for (int axis = 0; axis < 3; ++axis) {
        V3d unit(0);
        unit[axis] = scale;
        const V3d row = file_from_world(up, unit);
        for (int i = 0; i < 3; ++i) frame_from_world[axis][i] = row[i] + 0.0;  // no negative zeros
    }
    if (world_diameter > 0) {
        center = world_bounds.center() * frame_from_world;
        diameter = world_diameter * scale;
    }
}

std::string pov_camera(const Camera& camera, const PovFrame& frame) {
    // POV-Ray's camera looks along +z with +x to the left: the glTF camera turned by half a turn about its y axis.
    const Imath::M44d placed = camera.world_from_camera * frame.frame_from_world;
    const V3d x = -row_of(placed, 0).normalized();
    const V3d y = row_of(placed, 1).normalized();
    const V3d z = -row_of(placed, 2).normalized();
    const V3d position = row_of(placed, 3);
    const Imath::M44d pose(x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, position.x, position.y, position.z, 1);

    // The picture's plane is `up` high at the distance `direction`.
    const double height = camera.orthographic ? 2 * camera.half_height * frame.scale : 1;
    const double distance = camera.orthographic ? 1 : 0.5 / std::tan(camera.vertical_fov / 2);
    return fmt::format(
        "camera {{ // {}\n"
        "    {}\n"
        "    location <0, 0, 0>\n"
        "    direction z*{}\n"
        "    up y*{}\n"
        "    right -x*{}*image_width/image_height\n"
        "    {}\n"
        "}}\n",
        header_text(camera.name), camera.orthographic ? "orthographic" : "perspective", distance, height, height,
        pov_matrix(pose));
}

}  // namespace vmap
