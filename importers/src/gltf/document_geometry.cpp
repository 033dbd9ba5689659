// SPDX-License-Identifier: GPL-3.0-or-later
// meshes and skins
#include "../content_error.h"
#include "document_parts.h"
#include "json_object.h"

#include <vmap/printable.h>

#include <fmt/format.h>

namespace vmap::gltf {
namespace {

constexpr std::uint64_t largest_draco_id = 0xFFFF;

Attributes read_attributes(const JsonObject& object, std::size_t count) {
    Attributes attributes;
    object.for_each_index(count,
                          [&](const std::string& name, std::size_t index) { attributes.emplace_back(name, index); });
    return attributes;
}

Primitive read_primitive(const JsonObject& object, const Document& document) {
    Primitive primitive;
    primitive.where = object.where();
    const JsonObject attributes = object.required(object.object("attributes"), "attributes");
    primitive.attributes = read_attributes(attributes, document.accessors.size());
    if (primitive.attributes.empty()) object.fail("attributes", "at least one attribute");
    primitive.indices = object.index("indices", document.accessors.size());
    primitive.material = object.index("material", document.materials.size());
    primitive.mode = static_cast<PrimitiveMode>(object.integer("mode", 0, 6).value_or(4));
    if (object.array_size("targets") > 0)
        object.for_each("targets", [&](const JsonObject& target, std::size_t) {
            primitive.targets.push_back(read_attributes(target, document.accessors.size()));
        });
    if (const auto draco = object.extension("KHR_draco_mesh_compression")) {
        primitive.draco.emplace();
        primitive.draco->view = draco->required(draco->index("bufferView", document.views.size()), "bufferView");
        const JsonObject ids = draco->required(draco->object("attributes"), "attributes");
        primitive.draco->attributes = read_attributes(ids, largest_draco_id);
    }
    return primitive;
}

MeshInfo read_mesh(const JsonObject& object, std::size_t index, const Document& document) {
    MeshInfo mesh;
    mesh.name = printable(object.text("name").value_or(fmt::format("mesh {}", index)));
    if (object.array_size("primitives") == 0) object.fail_missing("primitives");
    object.for_each("primitives", [&](const JsonObject& primitive, std::size_t) {
        mesh.primitives.push_back(read_primitive(primitive, document));
    });
    const std::size_t targets = mesh.primitives.front().targets.size();
    for (const Primitive& primitive : mesh.primitives)
        if (primitive.targets.size() != targets)
            throw BrokenContent(object.where() + " has primitives with different numbers of morph targets");
    mesh.weights = object.numbers("weights");
    if (!mesh.weights.empty() && mesh.weights.size() != targets)
        object.fail("weights", fmt::format("one weight for each of {} morph targets", targets));
    mesh.weights.resize(targets, 0.0);
    mesh.radius = object.extra_number("radius");
    mesh.areas = object.extra_index("areas", document.accessors.size());
    return mesh;
}

/// Skins name nodes, whose number is known before the nodes are read.
SkinInfo read_skin(const JsonObject& object, std::size_t node_count, const Document& document) {
    SkinInfo skin;
    skin.joints = object.indices("joints", node_count);
    if (skin.joints.empty()) object.fail_missing("joints");
    skin.inverse_bind_matrices = object.index("inverseBindMatrices", document.accessors.size());
    static_cast<void>(object.index("skeleton", node_count));
    if (skin.inverse_bind_matrices) {
        const Accessor& accessor = document.accessors[*skin.inverse_bind_matrices];
        if (accessor.type != "MAT4" || accessor.component != ComponentType::float32 ||
            accessor.count < skin.joints.size())
            object.fail("inverseBindMatrices", fmt::format("an accessor of {} float matrices", skin.joints.size()));
    }
    return skin;
}

}  // namespace

void read_geometry(const JsonObject& root, Document& document) {
    document.meshes.reserve(root.array_size("meshes"));
    root.for_each("meshes", [&](const JsonObject& object, std::size_t index) {
        document.meshes.push_back(read_mesh(object, index, document));
    });
    const std::size_t node_count = root.array_size("nodes");
    document.skins.reserve(root.array_size("skins"));
    root.for_each("skins", [&](const JsonObject& object, std::size_t) {
        document.skins.push_back(read_skin(object, node_count, document));
    });
}

}  // namespace vmap::gltf
