// SPDX-License-Identifier: Apache-2.0
#include "octree_leaves.h"

#include <Imath/ImathBox.h>

#include <algorithm>
#include <cmath>

namespace vmap {
namespace {

using Imath::V3d;
using Imath::V3f;

struct Height {
    float height;
    std::uint32_t point;
};

/// What a cell's points say about the surface in it.
struct CellShape {
    V3f normal{0, 0, 0};     ///< mean direction, unit; 0 when there is none
    float largest_gap = 0;   ///< between neighbours in height that curvature explains
    float height_range = 0;  ///< of all points
};

float height(const V3f& normal, const V3f& from, const V3f& position) {
    return normal.dot(position - from);
}

CellShape measure(const PointCloud& cloud, std::span<const std::uint32_t> points) {
    V3d sum(0);
    for (const std::uint32_t i : points) sum += V3d(cloud.normals[i]);
    CellShape shape;
    shape.normal = V3f(sum.normalized());

    const V3f& from = cloud.positions[points.front()];
    Imath::Box3f box;
    float lowest = 0;
    float highest = 0;
    float cosine = 1;
    for (const std::uint32_t i : points) {
        box.extendBy(cloud.positions[i]);
        const float h = height(shape.normal, from, cloud.positions[i]);
        lowest = std::min(lowest, h);
        highest = std::max(highest, h);
        cosine = std::min(cosine, shape.normal.dot(cloud.normals[i]));
    }
    const float sine = std::sqrt(std::max(0.0F, 1 - cosine * cosine));
    shape.largest_gap = 0.5F * sine * (box.max - box.min).length();
    shape.height_range = highest - lowest;
    return shape;
}

/// A gap of noise alone: if all gaps were as large as the median one, this would be the whole range.
float noise_gap(const std::vector<Height>& sorted) {
    std::vector<float> gaps(sorted.size() - 1);
    for (std::size_t i = 0; i < gaps.size(); ++i) gaps[i] = sorted[i + 1].height - sorted[i].height;
    const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>((gaps.size() - 1) / 2);
    std::ranges::nth_element(gaps, middle);
    return *middle * static_cast<float>(sorted.size());
}

}  // namespace

std::vector<std::uint32_t> part_sheets(const PointCloud& cloud, std::span<std::uint32_t> points, float rounding) {
    const auto count = static_cast<std::uint32_t>(points.size());
    const CellShape shape = measure(cloud, points);
    const float smooth = std::max(shape.largest_gap, rounding);
    if (shape.height_range <= smooth) return {count};

    std::vector<Height> sorted(count);
    for (std::uint32_t i = 0; i < count; ++i)
        sorted[i] = {height(shape.normal, cloud.positions[points.front()], cloud.positions[points[i]]), points[i]};
    std::ranges::stable_sort(sorted, {}, &Height::height);

    // With two points the only gap is the median gap: nothing is known about noise, so that it does not count.
    const float gap = count == 2 ? smooth : std::max(smooth, noise_gap(sorted));
    std::vector<std::uint32_t> sheets;
    std::uint32_t sheet_begin = 0;
    for (std::uint32_t i = 1; i < count; ++i) {
        if (sorted[i].height - sorted[i - 1].height <= gap) continue;
        sheets.push_back(i - sheet_begin);
        sheet_begin = i;
    }
    sheets.push_back(count - sheet_begin);

    if (sheets.size() > 1)
        for (std::uint32_t i = 0; i < count; ++i) points[i] = sorted[i].point;
    return sheets;
}

}  // namespace vmap
