// SPDX-License-Identifier: Apache-2.0
#include "texels.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace vmap {
namespace {

using Imath::C3f;

/// Gives texels without weight the mean of their neighbours, ring after ring.
void spread_into_gaps(const TexelRaster& raster, std::span<C3f> values, std::vector<float>& weight) {
    const auto index = [&](int x, int y) { return std::size_t{raster.index(x, y) - raster.first}; };
    for (int round = 0; round < raster.width + raster.height; ++round) {
        std::vector<std::size_t> filled;
        bool gaps = false;
        for (int y = 0; y < raster.height; ++y)
            for (int x = 0; x < raster.width; ++x) {
                if (weight[index(x, y)] > 0) continue;
                gaps = true;
                C3f sum(0, 0, 0);
                float count = 0;
                for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, raster.height - 1); ++ny)
                    for (int nx = std::max(x - 1, 0); nx <= std::min(x + 1, raster.width - 1); ++nx)
                        if (weight[index(nx, ny)] > 0) {
                            sum += values[index(nx, ny)];
                            ++count;
                        }
                if (!(count > 0)) continue;
                values[index(x, y)] = sum / count;
                filled.push_back(index(x, y));
            }
        for (const std::size_t k : filled) weight[k] = 1;
        if (!gaps) break;
    }
}

}  // namespace

Texels::Texels(const Surface& surface, float size) : surface_(&surface), rasters_(surface.set.patches.size()) {
    for (std::size_t p = 0; p < rasters_.size(); ++p) {
        const Patch& patch = surface.set.patches[p];
        TexelRaster& raster = rasters_[p];
        raster.first = static_cast<std::uint32_t>(count_);
        if (patch.flat) {
            Imath::Box2f box;
            for (const Imath::V3f& v : surface.set.outlines[p]) box.extendBy(patch.to_plane(v));
            raster.low = box.min;
            raster.size = std::max(1.2F * patch.spacing(), size);
            raster.width = std::max(1, static_cast<int>(std::ceil(box.size().x / raster.size)));
            raster.height = std::max(1, static_cast<int>(std::ceil(box.size().y / raster.size)));
        }
        count_ += raster.count();
    }
}

std::vector<C3f> Texels::means_of(std::span<const C3f> values) const {
    std::vector<C3f> means(count_, C3f(0, 0, 0));
    tbb::parallel_for(std::size_t{0}, rasters_.size(), [&](std::size_t p) {
        average_patch(p, values, std::span(means).subspan(rasters_[p].first, rasters_[p].count()));
    });
    return means;
}

void Texels::average_patch(std::size_t p, std::span<const C3f> values, std::span<C3f> means) const {
    const Patch& patch = surface_->set.patches[p];
    const TexelRaster& raster = rasters_[p];
    std::vector<float> weight(raster.count(), 0.0F);
    for (const std::uint32_t i : surface_->set.points_of(patch)) {
        const std::uint32_t t = patch.flat ? raster.at(patch.to_plane(surface_->cloud.positions[i])) - raster.first : 0;
        means[t] += values[i] * surface_->cloud.areas[i];
        weight[t] += surface_->cloud.areas[i];
    }
    for (std::size_t k = 0; k < weight.size(); ++k)
        if (weight[k] > 0) means[k] /= weight[k];
    spread_into_gaps(raster, means, weight);
}

}  // namespace vmap
