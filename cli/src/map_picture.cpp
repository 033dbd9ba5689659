// SPDX-License-Identifier: GPL-3.0-or-later
#include "map_picture.h"

#include <vmap/query_vmap.h>
#include <vmap/show_visibility.h>

#include <algorithm>
#include <cmath>

namespace vmap {
namespace {

using Imath::C3f;
using Imath::V3d;
using Imath::V3f;

const C3f dark(0.02F, 0.03F, 0.08F);
const C3f light(0.90F, 0.78F, 0.45F);
const C3f marked(0.9F, 0.02F, 0.02F);

/// In mean point spacings, so that the mark is seen from across a room.
constexpr double mark_radius = 4;

/// A little shading, so that surfaces of one value can be told apart.
float shade(const V3f& normal) {
    return 0.55F + 0.45F * std::abs(normal.dot(V3f(0.35F, 0.80F, 0.49F)));
}

/// From dark at 0 to light at 1.
std::vector<C3f> paint_values(const PointCloud& cloud, const std::vector<float>& values) {
    std::vector<C3f> colors(cloud.size());
    for (std::size_t i = 0; i < colors.size(); ++i)
        colors[i] = (dark + (light - dark) * values[i]) * shade(cloud.normals[i]);
    return colors;
}

VmapQuery query_of(const VmapContents& contents) {
    return {contents.cloud, contents.tree, contents.map, contents.patches};
}

}  // namespace

std::vector<C3f> paint_visibility(const VmapContents& contents, const V3d& from) {
    const VmapQuery query = query_of(contents);
    const std::uint32_t source = query.nearest_point(from);
    std::vector<C3f> colors = paint_values(contents.cloud, visibility_from(query, contents.cloud.size(), source));
    double area = 0;
    for (const float a : contents.cloud.areas) area += static_cast<double>(a);
    const double spacing = std::sqrt(area / static_cast<double>(contents.cloud.size()));
    const V3d place = contents.cloud.origin + V3d(contents.cloud.positions[source]);
    for (const std::uint32_t i : query.points_around(place, mark_radius * spacing)) colors[i] = marked;
    return colors;
}

std::vector<C3f> paint_umbra(const VmapContents& contents) {
    const VmapQuery query = query_of(contents);
    return paint_values(contents.cloud,
                        umbra_picture(query, contents.cloud.size(), scene_lights(contents.cloud, contents.lights)));
}

std::vector<C3f> paint_leaves(const VmapContents& contents) {
    std::vector<C3f> colors(contents.cloud.size());
    for (std::size_t leaf = 0; leaf < contents.tree.leaves.size(); ++leaf) {
        // Multiples of the golden ratio and of its powers never come close to each other for long.
        const auto share = [&](double step) {
            const double at = step * static_cast<double>(leaf + 1);
            return static_cast<float>(0.12 + 0.78 * (at - std::floor(at)));
        };
        const C3f color(share(0.8191725134), share(0.6710436067), share(0.5497004779));
        for (const std::uint32_t i : contents.tree.points_of(contents.tree.nodes[contents.tree.leaves[leaf].node]))
            colors[i] = color;
    }
    return colors;
}

}  // namespace vmap
