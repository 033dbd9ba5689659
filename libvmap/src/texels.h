// SPDX-License-Identifier: Apache-2.0
/// \file
/// Radiosity of the surface on texels: a raster on every flat patch, one texel for a curved group. What rays meet.
#pragma once

#include "surface.h"

#include <Imath/ImathColor.h>
#include <Imath/ImathVec.h>

#include <algorithm>

#include <cstdint>
#include <span>
#include <vector>

namespace vmap {

/// Texels of one patch, rows from `low`.
struct TexelRaster {
    std::uint32_t first = 0;
    int width = 1;
    int height = 1;
    Imath::V2f low{0, 0};  ///< in the patch's plane
    float size = 1;        ///< edge of a texel, world units

    /// The texel that holds a place of the patch's plane, or the nearest one.
    [[nodiscard]] std::uint32_t at(const Imath::V2f& place) const {
        const int x = std::clamp(static_cast<int>((place.x - low.x) / size), 0, width - 1);
        const int y = std::clamp(static_cast<int>((place.y - low.y) / size), 0, height - 1);
        return index(x, y);
    }
    [[nodiscard]] std::uint32_t index(int x, int y) const {
        return first + static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(width) +
               static_cast<std::uint32_t>(x);
    }
    [[nodiscard]] std::uint32_t count() const {
        return static_cast<std::uint32_t>(width) * static_cast<std::uint32_t>(height);
    }
    [[nodiscard]] Imath::V2f middle(int x, int y) const {
        return low + Imath::V2f((static_cast<float>(x) + 0.5F) * size, (static_cast<float>(y) + 0.5F) * size);
    }
};

class Texels {
public:
    /// - size: edge of the texels on flat patches at least, world units; they are never finer than the points
    Texels(const Surface& surface, float size);

    /// Area-weighted means of values at the points; a texel without points takes those of its neighbours.
    /// - values: one per point, in the cloud's order
    [[nodiscard]] std::vector<Imath::C3f> means_of(std::span<const Imath::C3f> values) const;

    [[nodiscard]] const TexelRaster& raster(std::size_t patch) const { return rasters_[patch]; }
    [[nodiscard]] std::size_t size() const { return count_; }

private:
    void average_patch(std::size_t patch, std::span<const Imath::C3f> values, std::span<Imath::C3f> means) const;

    const Surface* surface_;
    std::vector<TexelRaster> rasters_;
    std::size_t count_ = 0;
};

}  // namespace vmap
