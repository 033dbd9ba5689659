// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vmap::picture {
namespace {

using Imath::V2d;
using Imath::V3d;

/// Shift of each row of places, in pixels: bit-reversed, so that neighbouring rows differ much.
constexpr std::array<double, rows_per_pixel> row_shift{0.5 / 16, 4.5 / 16, 2.5 / 16, 6.5 / 16,
                                                       1.5 / 16, 5.5 / 16, 3.5 / 16, 7.5 / 16};

/// Share of the depth by which coincident sheets are told apart: an emitting one lies in front, a back behind.
constexpr double coincidence = 1e-6;

constexpr std::size_t chunk_polygons = 4096;

/// Cuts a polygon in the camera's frame at the plane z = -nearest.
void clip(std::vector<V3d>& polygon, double nearest, std::vector<V3d>& clipped) {
    clipped.clear();
    V3d previous = polygon.back();
    for (const V3d& vertex : polygon) {
        const double before = -nearest - previous.z;
        const double after = -nearest - vertex.z;
        if ((before > 0) != (after > 0))
            clipped.push_back(previous + (vertex - previous) * (before / (before - after)));
        if (after > 0) clipped.push_back(vertex);
        previous = vertex;
    }
    polygon.swap(clipped);
}

}  // namespace

V2d place_in_pixel(int place) {
    const int row = place / columns_per_pixel;
    return {
        static_cast<double>(place % columns_per_pixel) / columns_per_pixel + row_shift[static_cast<std::size_t>(row)],
        (row + 0.5) / rows_per_pixel};
}

Raster::Raster(const Shapes& shapes, const View& view, double nearest)
    : shapes_(shapes),
      view_(view),
      tiles_across_((view.width() + tile_side - 1) / tile_side),
      tiles_down_((view.height() + tile_side - 1) / tile_side),
      coincidence_(nearest) {
    const std::size_t chunks = (shapes.polygons.size() + chunk_polygons - 1) / chunk_polygons;
    std::vector<Projection> parts(chunks);
    tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
        const std::size_t end = std::min(shapes.polygons.size(), (chunk + 1) * chunk_polygons);
        for (std::size_t p = chunk * chunk_polygons; p < end; ++p)
            project(static_cast<std::uint32_t>(p), nearest, parts[chunk]);
    });
    for (const Projection& part : parts) {
        const auto first_vertex = static_cast<std::uint32_t>(vertices_.size());
        for (Outline outline : part.outlines) {
            outline.first_vertex += first_vertex;
            outlines_.push_back(outline);
        }
        vertices_.insert(vertices_.end(), part.vertices.begin(), part.vertices.end());
    }
    sort_into_tiles();
}

Nearness Raster::plane(std::uint32_t polygon) const {
    return view_.nearness(V3d(shapes_.polygons[polygon][0]), V3d(shapes_.shapes[polygon].normal));
}

void Raster::project(std::uint32_t polygon, double nearest, Projection& to) const {
    const Shape& shape = shapes_.shapes[polygon];
    if (shape.normal == Imath::V3f(0)) return;
    thread_local std::vector<V3d> in_camera;
    thread_local std::vector<V3d> spare;
    in_camera.clear();
    for (const Imath::V3f& v : shapes_.polygons[polygon]) in_camera.push_back(view_.camera_from(V3d(v)));
    clip(in_camera, nearest, spare);
    if (in_camera.size() < 3) return;

    Outline outline;
    outline.polygon = polygon;
    outline.first_vertex = static_cast<std::uint32_t>(to.vertices.size());
    outline.vertex_count = static_cast<std::uint32_t>(in_camera.size());
    outline.nearness = plane(polygon);
    const bool front = view_.sees_front(V3d(shapes_.polygons[polygon][0]), V3d(shape.normal));
    const double behind = front ? (shape.emits ? 0 : 1) : 2;
    if (view_.orthographic()) {
        outline.nearness.constant -= behind * coincidence_;
    } else {
        outline.nearness.per_x *= 1 - behind * coincidence;
        outline.nearness.per_y *= 1 - behind * coincidence;
        outline.nearness.constant *= 1 - behind * coincidence;
    }

    V2d low(std::numeric_limits<double>::max());
    V2d high(std::numeric_limits<double>::lowest());
    for (const V3d& v : in_camera) {
        const V2d place = view_.picture_from(v);
        low = {std::min(low.x, place.x), std::min(low.y, place.y)};
        high = {std::max(high.x, place.x), std::max(high.y, place.y)};
        to.vertices.push_back(place);
    }
    const auto pixel = [](double at, int count) {
        return static_cast<int>(std::floor(std::clamp(at, -1.0, static_cast<double>(count))));
    };
    outline.pixels = {
        std::max(0, pixel(low.x, view_.width())), std::min(view_.width() - 1, pixel(high.x, view_.width())),
        std::max(0, pixel(low.y, view_.height())), std::min(view_.height() - 1, pixel(high.y, view_.height()))};
    if (outline.pixels[0] > outline.pixels[1] || outline.pixels[2] > outline.pixels[3]) {
        to.vertices.resize(outline.first_vertex);
        return;
    }
    to.outlines.push_back(outline);
}

void Raster::sort_into_tiles() {
    const auto for_tiles = [&](const Outline& outline, const auto& visit) {
        for (int y = outline.pixels[2] / tile_side; y <= outline.pixels[3] / tile_side; ++y)
            for (int x = outline.pixels[0] / tile_side; x <= outline.pixels[1] / tile_side; ++x)
                visit(static_cast<std::size_t>(y) * static_cast<std::size_t>(tiles_across_) +
                      static_cast<std::size_t>(x));
    };
    tile_first_.assign(static_cast<std::size_t>(tiles_across_) * static_cast<std::size_t>(tiles_down_) + 1, 0);
    for (const Outline& outline : outlines_) for_tiles(outline, [&](std::size_t tile) { ++tile_first_[tile + 1]; });
    for (std::size_t i = 1; i < tile_first_.size(); ++i) tile_first_[i] += tile_first_[i - 1];
    tile_outlines_.resize(tile_first_.back());
    std::vector<std::uint32_t> next(tile_first_.begin(), tile_first_.end() - 1);
    for (std::size_t i = 0; i < outlines_.size(); ++i)
        for_tiles(outlines_[i],
                  [&](std::size_t tile) { tile_outlines_[next[tile]++] = static_cast<std::uint32_t>(i); });
}

void Raster::draw(int tile_x, int tile_y, const CutTest& is_cut, TileContent& content) const {
    content.polygon.fill(nothing);
    content.nearness.fill(std::numeric_limits<float>::lowest());
    const std::size_t tile =
        static_cast<std::size_t>(tile_y) * static_cast<std::size_t>(tiles_across_) + static_cast<std::size_t>(tile_x);
    for (std::uint32_t i = tile_first_[tile]; i < tile_first_[tile + 1]; ++i)
        draw(outlines_[tile_outlines_[i]], tile_x * tile_side, tile_y * tile_side, is_cut, content);
}

/// Every row of places cuts a convex polygon in one run. Edges are evaluated from their upper end, so that polygons
/// that share one agree on it and neither overlap nor leave a gap.
void Raster::draw(const Outline& outline, int first_x, int first_y, const CutTest& is_cut, TileContent& content) const {
    const std::span<const V2d> vertices = std::span(vertices_).subspan(outline.first_vertex, outline.vertex_count);
    double low = vertices[0].y;
    double high = vertices[0].y;
    for (const V2d& v : vertices) {
        low = std::min(low, v.y);
        high = std::max(high, v.y);
    }
    const auto first_row_from = [&](double y) {
        const double row = std::ceil((y - first_y) * rows_per_pixel - 0.5);
        return static_cast<int>(std::clamp(row, 0.0, static_cast<double>(TileContent::rows)));
    };
    const int last_row = first_row_from(high);
    for (int row = first_row_from(low); row < last_row; ++row) {
        const double y = first_y + (row + 0.5) / rows_per_pixel;
        double left = std::numeric_limits<double>::max();
        double right = std::numeric_limits<double>::lowest();
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const V2d* a = &vertices[i];
            const V2d* b = &vertices[i + 1 < vertices.size() ? i + 1 : 0];
            if (a->y > b->y) std::swap(a, b);
            if (!(a->y <= y && y < b->y)) continue;
            const double x = a->x + (y - a->y) * ((b->x - a->x) / (b->y - a->y));
            left = std::min(left, x);
            right = std::max(right, x);
        }
        const double shift = row_shift[static_cast<std::size_t>(row % rows_per_pixel)];
        const auto column_from = [&](double x) {
            const double column = std::ceil((x - first_x - shift) * columns_per_pixel);
            return static_cast<int>(std::clamp(column, 0.0, static_cast<double>(TileContent::columns)));
        };
        const int end = column_from(right);
        const double start = outline.nearness.at(first_x + shift, y);
        const double step = outline.nearness.per_x / columns_per_pixel;
        for (int column = column_from(left); column < end; ++column) {
            const std::size_t at = TileContent::index(row, column);
            const auto nearness = static_cast<float>(start + step * column);
            if (!(nearness > content.nearness[at])) continue;
            if (is_cut && shapes_.shapes[outline.polygon].may_be_cut &&
                is_cut(outline.polygon, first_x + shift + static_cast<double>(column) / columns_per_pixel, y))
                continue;
            content.nearness[at] = nearness;
            content.polygon[at] = outline.polygon;
        }
    }
}

}  // namespace vmap::picture
