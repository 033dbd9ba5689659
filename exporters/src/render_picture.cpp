// SPDX-License-Identifier: GPL-3.0-or-later
#include <vmap/error.h>
#include <vmap/exporters/render_picture.h>

#include <Imath/ImathBox.h>

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <memory>

#include "picture/painter.h"
#include "picture/raster.h"
#include "picture/shapes.h"
#include "picture/view.h"

namespace vmap {
namespace {

using namespace picture;
using Imath::C3f;
using Imath::V2d;

void check(const LitCloud& cloud, const RenderConfig& config) {
    for (const int side : {config.width, config.height})
        if (side < 1 || side > max_picture_side)
            throw UsageError(fmt::format("picture size {}x{}: expected 1 to {} pixels a side", config.width,
                                         config.height, max_picture_side));
    if (config.content == PictureContent::paint && config.paint.size() != cloud.points.size())
        throw UsageError(fmt::format("picture: {} colours for {} points", config.paint.size(), cloud.points.size()));
    const bool needs_light = config.content == PictureContent::radiance || config.content == PictureContent::irradiance;
    if (needs_light && cloud.irradiance.size() != cloud.points.size())
        throw UsageError("picture: the points hold no irradiance, expected lit points");
}

/// Longest extent of what is drawn, world units; never 0.
double extent_of(const Shapes& shapes) {
    Imath::Box3f bounds;
    for (std::size_t i = 0; i < shapes.polygons.size(); ++i)
        for (const Imath::V3f& v : shapes.polygons[i]) bounds.extendBy(v);
    return bounds.isEmpty() ? 1 : std::max(static_cast<double>(bounds.size().length()), 1e-30);
}

/// What one thread works with.
struct Desk {
    TileContent tile;
    Painter::Workspace painter;
};

/// The pieces of surface that one pixel sees, and how many of its places each takes.
class PixelParts {
public:
    void add(const Painter& painter, const Glimpse& glimpse) {
        for (std::size_t part = 0; part < count_; ++part)
            if (painter.is_same_surface(places_[part][0], glimpse)) {
                places_[part][sizes_[part]++] = glimpse;
                return;
            }
        places_[count_][0] = glimpse;
        sizes_[count_++] = 1;
    }
    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] std::span<const Glimpse> operator[](std::size_t part) const {
        return std::span(places_[part]).first(sizes_[part]);
    }

private:
    std::array<std::array<Glimpse, places_per_pixel>, places_per_pixel> places_;
    std::array<std::size_t, places_per_pixel> sizes_{};
    std::size_t count_ = 0;
};

void paint_pixel(const Painter& painter, int x, int y, const TileContent& tile, int tile_x, int tile_y,
                 Painter::Workspace& workspace, C3f& pixel, float& alpha) {
    PixelParts parts;
    for (int place = 0; place < places_per_pixel; ++place) {
        const std::uint32_t polygon = tile.at(x - tile_x, y - tile_y, place);
        if (polygon != nothing) parts.add(painter, {polygon, V2d(x, y) + place_in_pixel(place)});
    }
    std::size_t covered = 0;
    std::size_t gap = 0;
    std::size_t around = 0;
    C3f around_color(0);
    C3f sum(0);
    for (std::size_t part = 0; part < parts.count(); ++part) {
        const std::size_t size = parts[part].size();
        covered += size;
        if (painter.is_rough_back(parts[part][0])) {
            gap += size;
            continue;
        }
        const C3f color = painter.color(parts[part], workspace);
        sum += color * static_cast<float>(size);
        if (size > around && painter.is_rough(parts[part][0])) {
            around = size;
            around_color = color;
        }
    }
    // A gap between the discs of a curved surface shows the inside of its far side: the surface around it closes it.
    if (gap <= around) sum += around_color * static_cast<float>(gap);
    pixel = sum / static_cast<float>(places_per_pixel);
    alpha = static_cast<float>(covered) / places_per_pixel;
}

}  // namespace

Picture render_picture(const LitCloud& cloud, const Camera& camera, const RenderConfig& config, const Scene* source) {
    check(cloud, config);
    const View view(camera, config.width, config.height, cloud.points.origin);
    Shapes shapes;
    if (source) shapes = shapes_of(*source, cloud.points);
    const PointField field(cloud.points, source ? shapes.point_sheets : emission_sheets(cloud.points));
    if (!source) shapes = shapes_of(cloud.points, field);
    const Raster raster(shapes, view, 1e-6 * extent_of(shapes));
    const Painter painter(cloud, field, shapes, view, config, source);
    Raster::CutTest is_cut;
    if (std::any_of(shapes.shapes.begin(), shapes.shapes.end(), [](const Shape& s) { return s.may_be_cut; }))
        is_cut = [&](std::uint32_t polygon, double x, double y) { return painter.is_cut(polygon, x, y); };

    Picture picture;
    picture.width = config.width;
    picture.height = config.height;
    const std::size_t pixels = static_cast<std::size_t>(config.width) * static_cast<std::size_t>(config.height);
    picture.pixels.resize(pixels);
    picture.alpha.resize(pixels);
    tbb::enumerable_thread_specific<std::unique_ptr<Desk>> desks([] { return std::make_unique<Desk>(); });
    tbb::parallel_for(0, raster.tiles_across() * raster.tiles_down(), [&](int tile) {
        Desk& desk = *desks.local();
        const int tile_x = tile % raster.tiles_across() * tile_side;
        const int tile_y = tile / raster.tiles_across() * tile_side;
        raster.draw(tile_x / tile_side, tile_y / tile_side, is_cut, desk.tile);
        for (int y = tile_y; y < std::min(tile_y + tile_side, config.height); ++y)
            for (int x = tile_x; x < std::min(tile_x + tile_side, config.width); ++x) {
                const std::size_t at =
                    static_cast<std::size_t>(y) * static_cast<std::size_t>(config.width) + static_cast<std::size_t>(x);
                paint_pixel(painter, x, y, desk.tile, tile_x, tile_y, desk.painter, picture.pixels[at],
                            picture.alpha[at]);
            }
    });
    return picture;
}

}  // namespace vmap
