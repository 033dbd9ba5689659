// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Which vertices of a scene are the same place, and which faces meet at an edge.
#pragma once

#include <vmap/scene.h>

#include <Imath/ImathVec.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vmap {

/// Files split a vertex where texture coordinates or normals differ; here equal places have one number again.
class WeldedVertices {
public:
    /// Places that agree as floats relative to the origin are one.
    WeldedVertices(const Scene& scene, const Imath::V3d& origin);

    /// Numbers of a triangle's vertices in the order of the mesh.
    [[nodiscard]] std::array<std::uint32_t, 3> of(std::size_t instance, std::size_t triangle) const;

private:
    const Scene* scene_;
    std::vector<std::size_t> first_;  ///< vertex of each instance
    std::vector<std::uint32_t> number_;
};

/// One side of a triangle, with the lower numbered vertex in front.
struct TriangleEdge {
    std::uint64_t vertices = 0;  ///< lower number in the upper half
    std::uint32_t triangle = 0;
    std::uint8_t corner = 0;    ///< the edge runs from this corner to the next
    bool is_ascending = false;  ///< runs from the lower numbered vertex to the higher

    [[nodiscard]] bool operator<(const TriangleEdge& other) const {
        return vertices != other.vertices ? vertices < other.vertices : triangle < other.triangle;
    }
};

[[nodiscard]] TriangleEdge triangle_edge(std::uint32_t triangle, int corner, std::uint32_t from, std::uint32_t to);

}  // namespace vmap
