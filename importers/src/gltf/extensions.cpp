// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions.h"

#include <algorithm>
#include <array>

namespace vmap::gltf {
namespace {

using enum ExtensionSupport;

// docs/inputs.md shows this table to users.
constexpr std::array known_extensions{
    Extension{"EXT_mesh_gpu_instancing", read, {}},
    Extension{"EXT_meshopt_compression", read, {}},
    Extension{"KHR_draco_mesh_compression", read, {}},
    Extension{"KHR_lights_punctual", read, {}},
    Extension{"KHR_materials_emissive_strength", read, {}},
    Extension{"KHR_mesh_quantization", read, {}},
    Extension{"KHR_node_visibility", read, {}},
    Extension{"KHR_texture_transform", read, {}},
    Extension{"KHR_materials_unlit", mapped, "unlit materials are treated as diffuse ones of their base colour"},
    Extension{"KHR_materials_pbrSpecularGlossiness", mapped,
              "specular-glossiness materials are treated as diffuse ones of their diffuse colour"},
    Extension{"KHR_materials_anisotropy", mapped, "anisotropic reflection is not modelled"},
    Extension{"KHR_materials_clearcoat", mapped, "clear coat is not modelled"},
    Extension{"KHR_materials_diffuse_transmission", mapped,
              "diffuse transmission is not modelled: surfaces are opaque"},
    Extension{"KHR_materials_dispersion", mapped, "dispersion is not modelled"},
    Extension{"KHR_materials_ior", mapped, "the index of refraction is not modelled"},
    Extension{"KHR_materials_iridescence", mapped, "iridescence is not modelled"},
    Extension{"KHR_materials_sheen", mapped, "sheen is not modelled"},
    Extension{"KHR_materials_specular", mapped, "specular reflection is not modelled"},
    Extension{"KHR_materials_transmission", mapped, "transmission is not modelled: surfaces are opaque"},
    Extension{"KHR_materials_variants", mapped,
              "material variants are not chosen from: the default materials are used"},
    Extension{"KHR_materials_volume", mapped, "volumes inside surfaces are not modelled"},
    Extension{"EXT_lights_image_based", mapped, "image-based lights of the file are not used"},
    Extension{"KHR_animation_pointer", mapped, {}},
    Extension{"KHR_xmp", mapped, {}},
    Extension{"KHR_xmp_json_ld", mapped, {}},
    // Their images are told one by one when they are met, see images.h.
    Extension{"EXT_texture_avif", mapped, {}},
    Extension{"EXT_texture_webp", mapped, {}},
    Extension{"KHR_texture_basisu", mapped, {}},
    Extension{"MSFT_texture_dds", mapped, {}},
};

}  // namespace

Extension find_extension(std::string_view name) {
    const auto* const found = std::find_if(known_extensions.begin(), known_extensions.end(),
                                           [&](const Extension& extension) { return extension.name == name; });
    return found == known_extensions.end() ? Extension{name, unknown, {}} : *found;
}

}  // namespace vmap::gltf
