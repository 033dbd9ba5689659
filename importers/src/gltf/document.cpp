// SPDX-License-Identifier: GPL-3.0-or-later
#include "document.h"

#include "../warnings.h"
#include "document_parts.h"
#include "json_object.h"

#include <algorithm>

namespace vmap::gltf {

std::uint32_t byte_size(ComponentType type) {
    switch (type) {
        case ComponentType::int8:
        case ComponentType::uint8:
            return 1;
        case ComponentType::int16:
        case ComponentType::uint16:
            return 2;
        default:
            return 4;
    }
}

std::optional<std::size_t> find_attribute(const Attributes& attributes, const std::string& name) {
    const auto found = std::find_if(attributes.begin(), attributes.end(),
                                    [&](const auto& attribute) { return attribute.first == name; });
    if (found == attributes.end()) return std::nullopt;
    return found->second;
}

bool uses_extension(const Document& document, std::string_view name) {
    const auto& used = document.extensions_used;
    return std::find(used.begin(), used.end(), name) != used.end();
}

Document read_document(const JsonObject& root, LightUnits units, Warnings& warnings) {
    Document document;
    read_asset_and_extensions(root, document, warnings);
    read_storage(root, document);
    read_surfaces(root, document, warnings);
    read_geometry(root, document);
    read_lights(root, units, document, warnings);
    read_cameras(root, document);
    read_nodes(root, document);
    read_scenes(root, document);
    if (root.array_size("animations") > 0)
        warnings.add("animations are not played: the scene is read at the pose of its nodes");
    return document;
}

}  // namespace vmap::gltf
