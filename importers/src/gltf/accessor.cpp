// SPDX-License-Identifier: GPL-3.0-or-later
#include "accessor.h"

#include "../content_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstring>
#include <limits>
#include <type_traits>

namespace vmap::gltf {
namespace {

// Zeros cost no bytes in the file, so their number says nothing about its size.
constexpr std::uint64_t most_unstored_elements = 1ULL << 22U;

template <class T>
T load(const std::byte* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return value;
}

template <class T>
float to_float(T value, bool normalized) {
    if constexpr (std::is_floating_point_v<T>) {
        return value;
    } else {
        const auto number = static_cast<float>(value);
        if (!normalized) return number;
        return std::max(number / static_cast<float>(std::numeric_limits<T>::max()), -1.0F);
    }
}

/// Calls a function with a value of the C++ type of the components.
template <class Function>
void with_type(ComponentType type, const Function& function) {
    switch (type) {
        case ComponentType::int8:
            return function(std::int8_t{});
        case ComponentType::uint8:
            return function(std::uint8_t{});
        case ComponentType::int16:
            return function(std::int16_t{});
        case ComponentType::uint16:
            return function(std::uint16_t{});
        case ComponentType::uint32:
            return function(std::uint32_t{});
        case ComponentType::float32:
            return function(float{});
    }
}

std::uint32_t packed_size(const Elements& elements) { return elements.components * byte_size(elements.component); }

std::vector<std::uint32_t> read_sparse_indices(const SparseInfo& sparse, std::uint64_t count, Buffers& buffers) {
    Elements indices;
    indices.data = buffers.view(sparse.index_view).data() + sparse.index_offset;
    indices.count = sparse.count;
    indices.component = sparse.index_type;
    indices.stride = byte_size(sparse.index_type);
    std::vector<std::uint32_t> replaced = read_integers(indices);
    if (std::adjacent_find(replaced.begin(), replaced.end(), std::greater_equal<>()) != replaced.end())
        throw BrokenContent("a sparse accessor's indices do not increase");
    if (replaced.back() >= count)
        throw BrokenContent(fmt::format("a sparse accessor replaces element {} of {}", replaced.back(), count));
    return replaced;
}

template <class T>
void write_element(const std::byte* element, std::uint32_t components, bool normalized, float* out) {
    for (std::uint32_t c = 0; c < components; ++c) out[c] = to_float(load<T>(element + c * sizeof(T)), normalized);
}

}  // namespace

Elements open_accessor(const Accessor& accessor, Buffers& buffers) {
    Elements elements;
    elements.count = accessor.count;
    elements.components = accessor.components;
    elements.component = accessor.component;
    elements.normalized = accessor.normalized;
    if (accessor.view) {
        const std::uint32_t stride = buffers_stride(accessor);
    }
    return elements;
}

}  // namespace vmap::gltf
