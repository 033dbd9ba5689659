// SPDX-License-Identifier: Apache-2.0
#include "surface.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace vmap {
namespace {

constexpr std::uint32_t tile_points = 48;

/// Halves the range at the middle of its longest side until it is a tile.
void cut_tiles(const PointCloud& cloud, std::vector<std::uint32_t>& order, std::uint32_t patch, std::uint32_t first,
               std::uint32_t count, std::vector<Tile>& tiles) {
    Tile tile{patch, first, count, {}};
    const auto begin = order.begin() + first;
    const auto end = begin + count;
    for (auto i = begin; i != end; ++i) tile.bounds.extendBy(cloud.positions[*i]);
    if (count <= tile_points) {
        tiles.push_back(tile);
        return;
    }
    const int axis = static_cast<int>(tile.bounds.majorAxis());
    const float at = tile.bounds.center()[axis];
    const auto middle = std::partition(begin, end, [&](std::uint32_t i) { return cloud.positions[i][axis] < at; });
    auto half = static_cast<std::uint32_t>(middle - begin);
    if (half == 0 || half == count) half = count / 2;
    cut_tiles(cloud, order, patch, first, half, tiles);
    cut_tiles(cloud, order, patch, first + half, count - half, tiles);
}

}  // namespace

Surface::Surface(const PointCloud& points) : cloud(points), set(find_patches(points)) {
    for (const Imath::V3f& p : cloud.positions) bounds.extendBy(p);
    diagonal = std::max(bounds.size().length(), 1e-30F);

    std::vector<std::vector<Tile>> cut(set.patches.size());
    tbb::parallel_for(std::size_t{0}, set.patches.size(), [&](std::size_t p) {
        const Patch& patch = set.patches[p];
        cut_tiles(cloud, set.point_order, static_cast<std::uint32_t>(p), patch.first_point, patch.point_count, cut[p]);
    });
    for (const std::vector<Tile>& part : cut) tiles.insert(tiles.end(), part.begin(), part.end());

    std::vector<float> dilation;
    dilation.reserve(set.patches.size());
    for (const Patch& patch : set.patches) dilation.push_back(patch.flat ? 1e-6F * diagonal : 0.35F * patch.spacing());
    bvh = PolygonBvh(set.outlines, {dilation});
    pencils = PencilTracer(set.outlines, dilation);
}

}  // namespace vmap
