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

/// The outlines with those that emit moved forward a little: of two sheets in one plane that face the same way, as a
/// lamp drawn onto its ceiling, rays shall meet the lamp.
PolygonSet emitters_in_front(const PatchSet& set, float step) {
    PolygonSet outlines;
    std::vector<Imath::V3f> vertices;
    for (std::size_t p = 0; p < set.patches.size(); ++p) {
        vertices.assign(set.outlines[p].begin(), set.outlines[p].end());
        if (set.patches[p].emits)
            for (Imath::V3f& v : vertices) v += set.patches[p].normal * step;
        outlines.add(vertices);
    }
    return outlines;
}

}  // namespace

Surface::Surface(const PointCloud& points) : cloud(points), set(find_patches(points)) {
    for (const Imath::V3f& p : cloud.positions) bounds.extendBy(p);
    diagonal = std::max(bounds.size().length(), 1e-30F);
    if (cloud.emits()) set.outlines = emitters_in_front(set, 4e-6F * diagonal);

    std::vector<std::vector<Tile>> cut(set.patches.size());
    tbb::parallel_for(std::size_t{0}, set.patches.size(), [&](std::size_t p) {
        const Patch& patch = set.patches[p];
        cut_tiles(cloud, set.point_order, static_cast<std::uint32_t>(p), patch.first_point, patch.point_count, cut[p]);
    });
    for (const std::vector<Tile>& part : cut) tiles.insert(tiles.end(), part.begin(), part.end());

    // Shadow rays must not slip between the groups of a closed surface. Rays that gather light are tried again there,
    // and with less growth the larger groups take less of the view from the smaller ones.
    const auto grown = [&](float spacings) {
        std::vector<float> growth;
        growth.reserve(set.patches.size());
        for (const Patch& patch : set.patches)
            growth.push_back(patch.flat ? 1e-6F * diagonal : spacings * patch.spacing());
        return growth;
    };
    const std::vector<float> closed = grown(0.35F);
    bvh = PolygonBvh(set.outlines, {closed});
    pencils = PencilTracer(set.outlines, grown(0.15F));

    PolygonSet outlines;
    std::vector<float> growth;
    for (std::uint32_t p = 0; p < set.patches.size(); ++p) {
        if (!set.patches[p].loose) continue;
        outlines.add(set.outlines[p]);
        growth.push_back(set.patches[p].spacing());
        loose_patches.push_back(p);
    }
    loose = PolygonBvh(outlines, {growth});
}

RayHit Surface::hit_in_crack(const Ray& ray) const {
    if (loose.empty()) return {};
    RayHit hit = loose.first_hit(ray);
    if (!hit || !hit.front) return {};
    hit.polygon = loose_patches[hit.polygon];
    return hit;
}

}  // namespace vmap
