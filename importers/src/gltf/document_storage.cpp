// SPDX-License-Identifier: GPL-3.0-or-later
// buffers, bufferViews and accessors: all the numbers by which memory is addressed later, checked in 64 bits.
#include "../content_error.h"
#include "document_parts.h"
#include "json_object.h"

#include <fmt/format.h>

#include <array>

namespace vmap::gltf {
namespace {

// Numbers up to here are exact in JSON, and no sum or product of two element sizes with one of them overflows 64 bits.
constexpr std::uint64_t largest_integer = 1ULL << 53U;

BufferInfo read_buffer(const JsonObject& object) {
    BufferInfo buffer;
    buffer.length = object.required(object.integer("byteLength", 1, largest_integer), "byteLength");
    buffer.uri = object.text("uri");
    if (const auto meshopt = object.extension("EXT_meshopt_compression"))
        buffer.fallback = meshopt->boolean("fallback").value_or(false);
    return buffer;
}

/// The part [offset, offset + length) of something that is size bytes long.
struct ByteRange {
    std::uint64_t offset = 0;
    std::uint64_t length = 0;
};

ByteRange read_range(const JsonObject& object, std::uint64_t size) {
    const std::uint64_t offset = object.integer("byteOffset", 0, largest_integer).value_or(0);
    const std::uint64_t length = object.required(object.integer("byteLength", 1, largest_integer), "byteLength");
    if (offset > size || length > size - offset)
        throw BrokenContent(
            fmt::format("{} covers bytes {} to {} of a buffer of {}", object.where(), offset, offset + length, size));
    return {offset, length};
}

MeshoptView read_meshopt(const JsonObject& object, const Document& document) {
    MeshoptView view;
    view.buffer = object.required(object.index("buffer", document.buffers.size()), "buffer");
    const ByteRange range = read_range(object, document.buffers[view.buffer].length);
    view.offset = range.offset;
    view.length = range.length;
    view.stride = static_cast<std::uint32_t>(object.required(object.integer("byteStride", 1, 256), "byteStride"));
    view.count = object.required(object.integer("count", 1, largest_integer / 256), "count");

    const std::string mode = object.required(object.text("mode"), "mode");
    if (mode == "ATTRIBUTES")
        view.mode = MeshoptMode::attributes;
    else if (mode == "TRIANGLES")
        view.mode = MeshoptMode::triangles;
    else if (mode == "INDICES")
        view.mode = MeshoptMode::indices;
    else
        object.fail("mode", "ATTRIBUTES, TRIANGLES or INDICES");

    const std::string filter = object.text("filter").value_or("NONE");
    if (filter == "NONE")
        view.filter = MeshoptFilter::none;
    else if (filter == "OCTAHEDRAL")
        view.filter = MeshoptFilter::octahedral;
    else if (filter == "QUATERNION")
        view.filter = MeshoptFilter::quaternion;
    else if (filter == "EXPONENTIAL")
        view.filter = MeshoptFilter::exponential;
    else
        object.fail("filter", "NONE, OCTAHEDRAL, QUATERNION or EXPONENTIAL");
    return view;
}

BufferView read_view(const JsonObject& object, const Document& document) {
    BufferView view;
    view.buffer = object.required(object.index("buffer", document.buffers.size()), "buffer");
    const ByteRange range = read_range(object, document.buffers[view.buffer].length);
    view.offset = range.offset;
    view.length = range.length;
    view.stride = static_cast<std::uint32_t>(object.integer("byteStride", 4, 252).value_or(0));
    if (view.stride % 4 != 0) object.fail("byteStride", "a multiple of 4");
    if (const auto meshopt = object.extension("EXT_meshopt_compression"))
        view.meshopt = read_meshopt(*meshopt, document);
    return view;
}

ComponentType read_component_type(const JsonObject& object) {
    const std::uint64_t number = object.required(object.integer("componentType", 0, 0xFFFF), "componentType");
    if (number < 5120 || number > 5126 || number == 5124)
        object.fail("componentType", "one of 5120 to 5123, 5125, 5126");
    return static_cast<ComponentType>(number);
}

struct ElementShape {
    std::string_view name;
    std::uint32_t rows;
    std::uint32_t columns;
};

constexpr std::array element_shapes{
    ElementShape{"SCALAR", 1, 1}, ElementShape{"VEC2", 2, 1}, ElementShape{"VEC3", 3, 1}, ElementShape{"VEC4", 4, 1},
    ElementShape{"MAT2", 2, 2},   ElementShape{"MAT3", 3, 3}, ElementShape{"MAT4", 4, 4}};

ElementShape read_shape(const JsonObject& object) {
    const std::string type = object.required(object.text("type"), "type");
    for (const ElementShape& shape : element_shapes)
        if (shape.name == type) return shape;
    object.fail("type", "SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 or MAT4");
}

/// Columns of matrices start at multiples of four bytes.
std::uint32_t element_size(const ElementShape& shape, ComponentType component) {
    const std::uint32_t column = shape.rows * byte_size(component);
    return shape.columns == 1 ? column : shape.columns * ((column + 3) / 4 * 4);
}

/// Checks that count elements from an offset on lie inside a view.
///
/// - alignment: of an element's components, in bytes
void check_fits(const JsonObject& object, const BufferView& view, std::uint64_t offset, std::uint64_t count,
                std::uint32_t size, std::uint32_t alignment) {
    const std::uint64_t stride = view.stride > 0 ? view.stride : size;
    if (stride < size)
        throw BrokenContent(fmt::format("{} has elements of {} bytes, {} bytes apart", object.where(), size, stride));
    if (offset % alignment != 0 || (offset + view.offset) % alignment != 0)
        throw BrokenContent(fmt::format("{}.byteOffset is not a multiple of {}", object.where(), alignment));
    if (offset > view.length || size > view.length - offset || (view.length - offset - size) / stride < count - 1)
        throw BrokenContent(fmt::format("{} has {} elements of {} bytes from byte {} on, but its view has {} bytes",
                                        object.where(), count, size, offset, view.length));
}

SparseInfo read_sparse(const JsonObject& object, const Document& document, const Accessor& accessor,
                       std::uint32_t size) {
    SparseInfo sparse;
    sparse.count = object.required(object.integer("count", 1, accessor.count), "count");

    const JsonObject indices = object.required(object.object("indices"), "indices");
    sparse.index_view = indices.required(indices.index("bufferView", document.views.size()), "bufferView");
    sparse.index_offset = indices.integer("byteOffset", 0, largest_integer).value_or(0);
    sparse.index_type = read_component_type(indices);
    if (sparse.index_type != ComponentType::uint8 && sparse.index_type != ComponentType::uint16 &&
        sparse.index_type != ComponentType::uint32)
        indices.fail("componentType", "5121, 5123 or 5125");
    const std::uint32_t index_size = byte_size(sparse.index_type);
    check_fits(indices, document.views[sparse.index_view], sparse.index_offset, sparse.count, index_size, index_size);

    const JsonObject values = object.required(object.object("values"), "values");
    sparse.value_view = values.required(values.index("bufferView", document.views.size()), "bufferView");
    sparse.value_offset = values.integer("byteOffset", 0, largest_integer).value_or(0);
    check_fits(values, document.views[sparse.value_view], sparse.value_offset, sparse.count, size,
               byte_size(accessor.component));

    // Sparse data are packed: a stride has no meaning there.
    for (const std::size_t view : {sparse.index_view, sparse.value_view})
        if (document.views[view].stride != 0)
            throw BrokenContent(fmt::format("{} uses bufferViews[{}], which has a byteStride", object.where(), view));
    return sparse;
}

Accessor read_accessor(const JsonObject& object, const Document& document) {
    Accessor accessor;
    accessor.component = read_component_type(object);
    const ElementShape shape = read_shape(object);
    accessor.type = shape.name;
    accessor.components = shape.rows * shape.columns;
    accessor.count = object.required(object.integer("count", 1, largest_integer), "count");
    accessor.normalized = object.boolean("normalized").value_or(false);
    accessor.offset = object.integer("byteOffset", 0, largest_integer).value_or(0);
    accessor.view = object.index("bufferView", document.views.size());

    const std::uint32_t size = element_size(shape, accessor.component);
    accessor.element_size = size;
    if (accessor.view)
        check_fits(object, document.views[*accessor.view], accessor.offset, accessor.count, size,
                   byte_size(accessor.component));
    if (const auto sparse = object.object("sparse")) accessor.sparse = read_sparse(*sparse, document, accessor, size);
    return accessor;
}

}  // namespace

void read_storage(const JsonObject& root, Document& document) {
    document.buffers.reserve(root.array_size("buffers"));
    root.for_each("buffers",
                  [&](const JsonObject& object, std::size_t) { document.buffers.push_back(read_buffer(object)); });
    document.views.reserve(root.array_size("bufferViews"));
    root.for_each("bufferViews", [&](const JsonObject& object, std::size_t) {
        document.views.push_back(read_view(object, document));
    });
    document.accessors.reserve(root.array_size("accessors"));
    root.for_each("accessors", [&](const JsonObject& object, std::size_t) {
        document.accessors.push_back(read_accessor(object, document));
    });
}

}  // namespace vmap::gltf
