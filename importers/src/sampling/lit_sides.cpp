// SPDX-License-Identifier: GPL-3.0-or-later
#include "lit_sides.h"

#include "closed_parts.h"

#include <vmap/surface_shading.h>

#include <algorithm>

namespace vmap {

std::vector<std::uint8_t> find_lit_sides(const Scene& scene, SampleSides sides, const Imath::V3d& origin) {
    const std::vector<std::size_t> first = first_faces(scene);
    std::vector<std::uint8_t> lit(first.back(), sides == SampleSides::both ? front_side | back_side : front_side);
    if (sides != SampleSides::automatic) return lit;

    bool any_double_sided = false;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        if (!scene.materials[scene.meshes[scene.instances[i].mesh].material].double_sided) continue;
        any_double_sided = true;
        std::fill(lit.begin() + static_cast<std::ptrdiff_t>(first[i]),
                  lit.begin() + static_cast<std::ptrdiff_t>(first[i + 1]), front_side | back_side);
    }
    if (any_double_sided) leave_out_insides(scene, origin, lit);
    return lit;
}

}  // namespace vmap
