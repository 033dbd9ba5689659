// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a camera sees in the middle of each pixel.
#pragma once

#include <reference/reference_tracer.h>
#include <vmap/scene.h>

#include <Imath/ImathColor.h>

#include <cstddef>
#include <vector>

namespace vmap::crosscheck {

struct SurfacePixel {
    bool lit_side = false;  ///< a surface that can be lit is seen; the rest holds only then
    reference::ReferencePoint point;
    Imath::C3f albedo{0, 0, 0};    ///< clamped to [0, 1]
    Imath::C3f emission{0, 0, 0};  ///< W/(m^2 sr)
    bool border = false;  ///< within one pixel something else is seen: another plane, material or colour, nothing
};

struct SurfaceView {
    int width = 0;
    int height = 0;
    std::vector<SurfacePixel> pixels;  ///< rows from the top

    [[nodiscard]] std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
};

/// - camera: perspective
[[nodiscard]] SurfaceView view_surface(const Scene& scene, const Camera& camera, int width, int height);

/// Which pixels have a pixel within `distance` rows and columns for which `differs(pixel, neighbour)` holds.
template <class F>
[[nodiscard]] std::vector<bool> near_difference(const SurfaceView& view, int distance, const F& differs) {
    std::vector<bool> near(view.pixels.size(), false);
    for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x)
            for (int v = std::max(0, y - distance); v <= std::min(view.height - 1, y + distance); ++v)
                for (int u = std::max(0, x - distance); u <= std::min(view.width - 1, x + distance); ++u)
                    if (differs(view.index(x, y), view.index(u, v))) near[view.index(x, y)] = true;
    return near;
}

}  // namespace vmap::crosscheck
