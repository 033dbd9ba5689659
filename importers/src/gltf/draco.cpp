// SPDX-License-Identifier: GPL-3.0-or-later
#include "draco.h"

#include "../content_error.h"
#include "draco_header.h"

#include <draco/compression/decode.h>
#include <draco/mesh/mesh.h>
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

namespace vmap::gltf {
namespace {

// What libdraco holds while it decodes: corner tables, symbols and attribute maps.
constexpr std::uint64_t working_bytes_per_face = 64;
constexpr std::uint64_t working_bytes_per_point = 16;

std::unique_ptr<draco::Mesh> decode(std::span<const std::byte> bytes) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    try {
        auto result = decoder.DecodeMeshFromBuffer(&buffer);
        if (result.ok() && result.value() != nullptr) return std::move(result).value();
        throw BrokenContent("its Draco data are damaged");
    } catch (const std::length_error&) {
        throw BrokenContent("its Draco data claim an impossible size");
    }
}

ComponentType component_type(draco::DataType type) {
    switch (type) {
        case draco::DT_INT8:
            return ComponentType::int8;
        case draco::DT_UINT8:
            return ComponentType::uint8;
        case draco::DT_INT16:
            return ComponentType::int16;
        case draco::DT_UINT16:
            return ComponentType::uint16;
        case draco::DT_UINT32:
            return ComponentType::uint32;
        case draco::DT_FLOAT32:
            return ComponentType::float32;
        default:
            throw BrokenContent("its Draco data have components of a type that glTF does not have");
    }
}

void read_indices(const draco::Mesh& mesh, DracoMesh& result) {
    result.indices.reserve(3 * static_cast<std::size_t>(mesh.num_faces()));
    for (std::uint32_t f = 0; f < mesh.num_faces(); ++f)
        for (const draco::PointIndex& point : mesh.face(draco::FaceIndex(f))) {
            if (point.value() >= result.vertex_count) throw BrokenContent("its Draco data name a vertex too many");
            result.indices.push_back(point.value());
        }
}

/// One attribute, an element for every vertex.
void read_attribute(const draco::PointAttribute& attribute, const std::string& name, bool normalized, Buffers& buffers,
                    DracoMesh& result) {
    Elements elements;
    elements.count = result.vertex_count;
    elements.component = component_type(attribute.data_type());
    elements.components = static_cast<std::uint32_t>(attribute.num_components());
    elements.stride = elements.components * byte_size(elements.component);
    elements.normalized = normalized;
    if (attribute.byte_stride() != static_cast<std::int64_t>(elements.stride))
        throw BrokenContent("its Draco data are damaged");
    buffers.spend(elements.count, elements.stride);
    Bytes bytes(elements.count * elements.stride);
    for (std::uint32_t i = 0; i < elements.count; ++i) {
        const draco::AttributeValueIndex value = attribute.mapped_index(draco::PointIndex(i));
        if (value.value() >= attribute.size()) throw BrokenContent("its Draco data are damaged");
        attribute.GetValue(value, bytes.data() + static_cast<std::size_t>(i) * elements.stride);
    }
    elements.data = bytes.data();
    result.storage.push_back(std::move(bytes));
    result.attributes.emplace_back(name, std::move(elements));
}

}  // namespace

const Elements* DracoMesh::find(const std::string& attribute) const {
    const auto found =
        std::find_if(attributes.begin(), attributes.end(), [&](const auto& entry) { return entry.first == attribute; });
    return found == attributes.end() ? nullptr : &found->second;
}

DracoMesh decode_draco(const Document& document, const Primitive& primitive, const DracoInfo& draco, Buffers& buffers) {
    const std::span<const std::byte> bytes = buffers.view(draco.view);
    const DracoSizes sizes = read_draco_sizes(bytes);
    if (primitive.indices && document.accessors[*primitive.indices].count != 3 * sizes.faces)
        throw BrokenContent(fmt::format("its Draco data have {} triangles, but its indices are {}", sizes.faces,
                                        document.accessors[*primitive.indices].count));
    buffers.spend(sizes.faces, working_bytes_per_face);
    buffers.spend(sizes.points, working_bytes_per_point);

    const std::unique_ptr<draco::Mesh> mesh = decode(bytes);
    DracoMesh result;
    result.vertex_count = mesh->num_points();
    read_indices(*mesh, result);
    for (const auto& [name, id] : draco.attributes) {
        const draco::PointAttribute* attribute = mesh->GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
        const std::optional<std::size_t> accessor = find_attribute(primitive.attributes, name);
        if (attribute == nullptr || !accessor)
            throw BrokenContent(fmt::format("its Draco data and its attributes do not agree on {}", name));
        read_attribute(*attribute, name, document.accessors[*accessor].normalized, buffers, result);
    }
    return result;
}

}  // namespace vmap::gltf
