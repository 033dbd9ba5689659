// SPDX-License-Identifier: Apache-2.0
/// \file
/// Flat convex polygons in one array: what rays and shafts meet.
#pragma once

#include <Imath/ImathVec.h>

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vmap {

/// Vertices that a polygon may have, so that clipping needs no heap.
inline constexpr std::size_t max_polygon_vertices = 16;

/// Polygons one after the other. Each is flat, convex and counter-clockwise seen from its front.
class PolygonSet {
public:
    /// - vertices: 3 to max_polygon_vertices, any one frame for the whole set
    void add(std::span<const Imath::V3f> vertices) {
        assert(vertices.size() >= 3 && vertices.size() <= max_polygon_vertices);
        vertices_.insert(vertices_.end(), vertices.begin(), vertices.end());
        first_.push_back(static_cast<std::uint32_t>(vertices_.size()));
    }

    void reserve(std::size_t polygons, std::size_t vertices) {
        first_.reserve(polygons + 1);
        vertices_.reserve(vertices);
    }

    [[nodiscard]] std::size_t size() const { return first_.size() - 1; }
    [[nodiscard]] bool empty() const { return size() == 0; }

    [[nodiscard]] std::span<const Imath::V3f> operator[](std::size_t polygon) const {
        return std::span(vertices_).subspan(first_[polygon], first_[polygon + 1] - first_[polygon]);
    }

private:
    std::vector<Imath::V3f> vertices_;
    std::vector<std::uint32_t> first_{0};
};

}  // namespace vmap
