// SPDX-License-Identifier: Apache-2.0
/// \file
/// Oriented points that stand for a surface: what the tree, the V-map and the light work on.
#pragma once

#include <Imath/ImathColor.h>
#include <Imath/ImathVec.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vmap {

/// A surface as oriented points, one array per attribute. Every array that is not empty has size() elements.
struct PointCloud {
    Imath::V3d origin{0, 0, 0};            ///< world position that positions are relative to, world units
    std::vector<Imath::V3f> positions;     ///< relative to origin, world units
    std::vector<Imath::V3f> normals;       ///< unit length, towards the lit side
    std::vector<float> areas;              ///< surface that each point stands for, world units squared
    std::vector<Imath::C3f> albedo;        ///< diffuse reflectance, linear Rec.709, in [0, 1]
    std::vector<Imath::C3f> emission;      ///< emitted radiance Le, W/(m^2 sr); empty when nothing emits
    std::vector<std::uint32_t> faces;      ///< triangle of the source, in the order of the file; may be empty
    std::vector<std::uint32_t> materials;  ///< material of the source, in the order of the file; may be empty

    [[nodiscard]] std::size_t size() const { return positions.size(); }
    [[nodiscard]] bool empty() const { return positions.empty(); }
    [[nodiscard]] bool emits() const { return !emission.empty(); }

    friend bool operator==(const PointCloud&, const PointCloud&) = default;
};

/// A point cloud and the light on it.
struct LitCloud {
    PointCloud points;
    std::vector<Imath::C3f> irradiance;  ///< E at each point, W/m^2, linear Rec.709

    friend bool operator==(const LitCloud&, const LitCloud&) = default;
};

}  // namespace vmap
