// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The colour of what a pixel sees.
#pragma once

#include <vmap/exporters/render_picture.h>
#include <vmap/surface_shading.h>

#include <Imath/ImathColor.h>
#include <Imath/ImathVec.h>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "point_field.h"
#include "raster.h"
#include "shapes.h"
#include "view.h"

namespace vmap::picture {

/// A place of the picture and the polygon that is seen there.
struct Glimpse {
    std::uint32_t polygon = nothing;
    Imath::V2d place{0, 0};
};

class Painter {
public:
    struct Workspace {
        PointField::Workspace field;
        Mix mix;
    };

    /// Keeps references to all arguments.
    /// - source: the scene whose faces the shapes are, or null
    Painter(const LitCloud& cloud, const PointField& field, const Shapes& shapes, const View& view,
            const RenderConfig& config, const Scene* source);

    /// Whether an alpha mask cuts the polygon away at a picture place.
    [[nodiscard]] bool is_cut(std::uint32_t polygon, double x, double y) const;

    /// Whether what is seen at a second place is the same piece of surface as at the first: near, and turned alike.
    [[nodiscard]] bool is_same_surface(const Glimpse& first, const Glimpse& second) const;

    /// Whether a curved surface is seen that is known by its points only, and whether what is seen is its black back.
    [[nodiscard]] bool is_rough(const Glimpse& glimpse) const { return shapes_.shapes[glimpse.polygon].curved; }
    [[nodiscard]] bool is_rough_back(const Glimpse& glimpse) const;

    /// Mean colour of one piece of surface within a pixel, over the given places of it (at least one).
    [[nodiscard]] Imath::C3f color(std::span<const Glimpse> places, Workspace& workspace) const;

private:
    /// What lies at a place of the picture.
    struct Sighted {
        std::uint32_t polygon = 0;
        Imath::V3d position{0, 0, 0};  ///< relative to the cloud's origin
        Imath::V3d normal{0, 0, 1};    ///< towards the camera
        bool front = true;
        double cos = 1;    ///< between the normal and the ray of sight
        double pixel = 0;  ///< width of a pixel there, world units
    };

    [[nodiscard]] Sighted sighted(const Glimpse& glimpse) const;
    [[nodiscard]] SurfacePlace place_on_scene(const Sighted& seen) const;
    [[nodiscard]] std::size_t taps_for(const Sighted& seen, std::size_t places) const;
    [[nodiscard]] Imath::C3f color_at(const Sighted& seen, Workspace& workspace) const;
    [[nodiscard]] Imath::C3f albedo_at(const Sighted& seen, const Mix& mix) const;
    [[nodiscard]] Imath::C3f emission_at(const Sighted& seen, const Mix& mix) const;

    const LitCloud& cloud_;
    const PointField& field_;
    const Shapes& shapes_;
    const View& view_;
    const RenderConfig& config_;
    const Scene* source_;
    std::optional<SurfaceShading> shading_;
    std::vector<std::size_t> first_face_;
};

}  // namespace vmap::picture
