// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Vertices and polygons as the mesh formats have them, before they become a Scene.
#pragma once

#include <vmap/tree.h>

#include <Imath/ImathColor.h>
#include <Imath/ImathVec.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace vmap {

/// Positions as floats about an origin that keeps them exact enough.
struct FramedPositions {
    Imath::V3d origin{0, 0, 0};
    std::vector<Imath::V3f> offsets;  ///< position minus origin

    [[nodiscard]] std::size_t size() const { return offsets.size(); }
};

/// Chooses the origin: zero as long as floats lose next to nothing against the extent of the positions, else near their
/// middle.
[[nodiscard]] FramedPositions frame_positions(const std::vector<Imath::V3d>& positions);

/// Polygons over shared vertices, in the axes of the file. Indices are in range; each array that is not empty has the
/// size that its comment says.
struct PolygonSoup {
    FramedPositions positions;
    std::vector<Imath::C3f> colors;   ///< linear, of each position; may be empty
    std::vector<Imath::V3f> normals;  ///< of each position, or what corner_normals count; may be empty
    std::vector<Imath::V2f>
        texcoords;  ///< v runs downwards as in glTF; of each position, or what corner_texcoords count

    std::vector<std::uint32_t> corners;           ///< positions of all polygons, one polygon after the other
    std::vector<std::uint32_t> corner_normals;    ///< of each corner, no_index where it has none; may be empty
    std::vector<std::uint32_t> corner_texcoords;  ///< of each corner, no_index where it has none; may be empty

    std::vector<std::uint32_t> polygon_sizes;      ///< corners of each polygon; fewer than 3 enclose nothing
    std::vector<std::uint32_t> polygon_materials;  ///< of each polygon; empty: material 0
    std::vector<Imath::C3f> polygon_colors;        ///< linear, of each polygon; may be empty
};

}  // namespace vmap
