// SPDX-License-Identifier: GPL-3.0-or-later
// nodes and scenes. The references between nodes are checked here one by one; node_graph.h checks that they form trees.
#include "../content_error.h"
#include "document_parts.h"
#include "json_object.h"
#include "transform.h"

#include <vmap/printable.h>

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace vmap::gltf {
namespace {

Imath::M44d read_matrix(const JsonObject& object) {
    // Columns in the file, rows in Imath: with column vectors there and row vectors here it is the same order of
    // numbers.
    std::array<double, 16> m{};
    object.numbers("matrix", m);
    constexpr double rounding = 1e-6;
    if (std::abs(m[3]) > rounding || std::abs(m[7]) > rounding || std::abs(m[11]) > rounding ||
        std::abs(m[15] - 1) > rounding)
        throw BrokenContent(object.where() + ".matrix is not affine: its last row is not 0 0 0 1");
    return {m[0], m[1], m[2], 0, m[4], m[5], m[6], 0, m[8], m[9], m[10], 0, m[12], m[13], m[14], 1};
}

Imath::M44d read_pose(const JsonObject& object) {
    Transform transform;
    object.numbers("translation", transform.translation);
    object.numbers("scale", transform.scale);
    if (object.numbers("rotation", transform.rotation, {-1.001, 1.001})) {
        constexpr double tolerance = 1e-2;  // quantised quaternions are off by less
        const auto& [x, y, z, w] = transform.rotation;
        const double length = std::hypot(std::hypot(x, y), std::hypot(z, w));
        if (std::abs(length - 1) > tolerance)
            throw BrokenContent(fmt::format("{}.rotation has length {:.4g}, expected 1", object.where(), length));
    }
    return matrix_of(transform);
}

InstancingInfo read_instancing(const JsonObject& extension, const Document& document) {
    const JsonObject attributes = extension.required(extension.object("attributes"), "attributes");
    InstancingInfo instancing;
    attributes.for_each_index(document.accessors.size(), [&](const std::string& name, std::size_t accessor) {
        if (name == "TRANSLATION")
            instancing.translation = accessor;
        else if (name == "ROTATION")
            instancing.rotation = accessor;
        else if (name == "SCALE")
            instancing.scale = accessor;
    });
    return instancing;
}

std::uint32_t read_reference(const JsonObject& object, const char* key, std::size_t count) {
    const std::optional<std::size_t> index = object.index(key, count);
    return index ? static_cast<std::uint32_t>(*index) : Node::none;
}

std::unique_ptr<NodeExtras> read_extras(const JsonObject& object, const Document& document) {
    NodeExtras extras;
    extras.skin = object.index("skin", document.skins.size());
    extras.weights = object.numbers("weights");
    if (const auto extension = object.extension("EXT_mesh_gpu_instancing"))
        extras.instancing = read_instancing(*extension, document);
    if (!extras.skin && extras.weights.empty() && !extras.instancing) return nullptr;
    return std::make_unique<NodeExtras>(std::move(extras));
}

Node read_node(const JsonObject& object, const Document& document, std::size_t node_count) {
    Node node;
    if (const auto name = object.text("name")) node.name = printable(*name);
    const bool has_pose = object.has("translation") || object.has("rotation") || object.has("scale");
    if (object.has("matrix") && has_pose)
        throw BrokenContent(object.where() + " has a matrix beside translation, rotation or scale");
    node.pose = object.has("matrix") ? read_matrix(object) : read_pose(object);

    for (const std::size_t child : object.indices("children", node_count))
        node.children.push_back(static_cast<std::uint32_t>(child));
    node.mesh = read_reference(object, "mesh", document.meshes.size());
    node.camera = read_reference(object, "camera", document.cameras.size());
    if (const auto light = object.extension("KHR_lights_punctual")) {
        node.light = read_reference(*light, "light", document.lights.size());
        if (node.light == Node::none) light->fail_missing("light");
    }
    if (const auto visibility = object.extension("KHR_node_visibility"))
        node.visible = visibility->boolean("visible").value_or(true);

    node.extras = read_extras(object, document);
    if (node.extras != nullptr && !node.extras->weights.empty()) {
        const std::size_t targets = node.mesh == Node::none ? 0 : document.meshes[node.mesh].weights.size();
        if (node.extras->weights.size() != targets)
            object.fail("weights", fmt::format("one weight for each of {} morph targets", targets));
    }
    return node;
}

}  // namespace

void read_nodes(const JsonObject& root, Document& document) {
    const std::size_t node_count = root.array_size("nodes");
    if (node_count >= Node::none) throw UnsupportedContent("the document has more nodes than are read");
    document.nodes.reserve(node_count);
    root.for_each("nodes", [&](const JsonObject& object, std::size_t) {
        document.nodes.push_back(read_node(object, document, node_count));
    });
}

void read_scenes(const JsonObject& root, Document& document) {
    document.scenes.reserve(root.array_size("scenes"));
    root.for_each("scenes", [&](const JsonObject& object, std::size_t) {
        document.scenes.push_back(
            {printable(object.text("name").value_or("")), object.indices("nodes", document.nodes.size())});
    });
    document.default_scene = root.index("scene", document.scenes.size());
}

}  // namespace vmap::gltf
