// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Triangles, areas and box of a scene in the world, for comparison with expected values.
#pragma once

#include <vmap/scene.h>

#include <Imath/ImathBox.h>
#include <Imath/ImathVec.h>

#include <cstddef>

namespace vmap::test {

struct Measure {
    std::size_t triangles = 0;
    double area = 0;
    double lit_area = 0;  ///< double-sided surfaces count twice
    double emissive_area = 0;
    Imath::Box3d box;
};

inline Measure measure_of(const Scene& scene) {
    Measure measure;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        const Material& material = scene.materials[mesh.material];
        double area = 0;
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
            const auto corner = [&](std::size_t k) {
                return Imath::V3d(mesh.positions[mesh.indices[i + k]]) * instance.world_from_mesh;
            };
            area += (corner(1) - corner(0)).cross(corner(2) - corner(0)).length() / 2;
            for (std::size_t k = 0; k < 3; ++k) measure.box.extendBy(corner(k));
        }
        measure.triangles += mesh.triangle_count();
        measure.area += area;
        measure.lit_area += material.double_sided ? 2 * area : area;
        measure.emissive_area += material.emits() ? area : 0;
    }
    return measure;
}

}  // namespace vmap::test
