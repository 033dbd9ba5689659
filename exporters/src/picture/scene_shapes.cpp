// SPDX-License-Identifier: GPL-3.0-or-later
#include <vmap/error.h>
#include <vmap/exporters/output_info.h>
#include <vmap/printable.h>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "shapes.h"

namespace vmap::picture {
namespace {

using Imath::V3d;
using Imath::V3f;

/// Throws unless the points lie where the scene has the faces that they name.
void expect_match(const Scene& scene, const PointCloud& cloud, const Shapes& shapes) {
    const auto refuse = [&](const std::string& found) {
        throw UsageError(fmt::format("{}: {}; expected the scene that the points were sampled from",
                                     printable(scene.source), found));
    };
    if (cloud.faces.empty()) return;
    const std::uint32_t last = *std::max_element(cloud.faces.begin(), cloud.faces.end());
    if (last >= shapes.shapes.size())
        refuse(fmt::format("it has {} faces, but a point lies on face {}", shapes.shapes.size(), last));

    const double tolerance = 0.1 * mean_spacing(cloud);
    constexpr std::size_t probes = 256;
    const std::size_t step = std::max<std::size_t>(1, cloud.size() / probes);
    for (std::size_t i = 0; i < cloud.size(); i += step) {
        const std::size_t face = cloud.faces[i];
        const V3d offset = V3d(cloud.positions[i]) - V3d(shapes.polygons[face][0]);
        const double height = std::abs(offset.dot(V3d(shapes.shapes[face].normal)));
        if (height > tolerance) refuse(fmt::format("point {} is not on its face {}", i, face));
    }
}

}  // namespace

Shapes shapes_of(const Scene& scene, const PointCloud& cloud) {
    const std::vector<std::size_t> first_face = first_faces(scene);
    Shapes result;
    result.polygons.reserve(first_face.back(), 3 * first_face.back());
    result.shapes.reserve(first_face.back());
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
        const Material& material = scene.materials[mesh.material];
        const bool mirrored = is_mirrored(scene.instances[i]);
        for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
            std::array<V3d, 3> world = world_triangle(scene, i, t);
            if (mirrored) std::swap(world[1], world[2]);
            const V3d across = (world[1] - world[0]).cross(world[2] - world[0]);
            const double length = across.length();
            Shape shape;
            if (length > 0 && std::isfinite(length)) shape.normal = V3f(across / length);
            shape.sheet = static_cast<std::uint32_t>(i);
            shape.emits = material.emits();
            shape.has_back = material.double_sided;
            shape.may_be_cut = material.alpha_mode == AlphaMode::mask;
            result.shapes.push_back(shape);
            const std::array<V3f, 3> vertices{V3f(world[0] - cloud.origin), V3f(world[1] - cloud.origin),
                                              V3f(world[2] - cloud.origin)};
            result.polygons.add(vertices);
        }
    }
    expect_match(scene, cloud, result);

    if (cloud.faces.empty()) {
        for (Shape& shape : result.shapes) shape.sheet = any_sheet;
        result.point_sheets.assign(cloud.size(), any_sheet);
        return result;
    }
    result.point_polygons = cloud.faces;
    // Points on the back of a face: all faces of that part of the scene have their backs lit.
    std::vector<char> back_lit(scene.instances.size(), 0);
    result.point_sheets.resize(cloud.size());
    for (std::size_t p = 0; p < cloud.size(); ++p) {
        const Shape& shape = result.shapes[cloud.faces[p]];
        result.point_sheets[p] = shape.sheet;
        if (cloud.normals[p].dot(shape.normal) < 0) back_lit[shape.sheet] = 1;
    }
    for (Shape& shape : result.shapes) shape.has_back = shape.has_back || back_lit[shape.sheet] != 0;
    return result;
}

}  // namespace vmap::picture
