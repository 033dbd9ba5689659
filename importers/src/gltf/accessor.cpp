// SPDX-License-Identifier: GPL-3.0-or-later
#include "accessor.h"

#include "../content_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstring>
#include <functional>
#include <limits>
#include <type_traits>

namespace vmap::gltf {
namespace {

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

template <class T>
void read_element(const std::byte* element, std::uint32_t components, bool normalized, float* out) {
    for (std::uint32_t c = 0; c < components; ++c) out[c] = to_float(load<T>(element + c * sizeof(T)), normalized);
}

/// Calls a function with the place of each selected element in the output and its number.
template <class Function>
void for_each_selected(const Selection& selection, std::uint64_t count, const Function& function) {
    if (selection.all)
        for (std::size_t i = 0; i < count; ++i) function(i, i);
    else
        for (std::size_t i = 0; i < selection.chosen.size(); ++i) function(i, selection.chosen[i]);
}

/// Calls a function with the place in the output of each replaced element that is selected and its replacement.
template <class Function>
void for_each_replaced(const Elements& elements, const Selection& selection, const Function& function) {
    const std::size_t size = elements.components * byte_size(elements.component);
    auto next = selection.chosen.begin();
    for (std::size_t i = 0; i < elements.replaced.size(); ++i) {
        std::size_t place = elements.replaced[i];
        if (!selection.all) {
            next = std::lower_bound(next, selection.chosen.end(), elements.replaced[i]);
            if (next == selection.chosen.end()) return;
            if (*next != elements.replaced[i]) continue;
            place = static_cast<std::size_t>(next - selection.chosen.begin());
        }
        function(place, elements.replacements.subspan(i * size, size).data());
    }
}

void open_sparse(const SparseInfo& sparse, Buffers& buffers, Elements& elements) {
    Elements indices;
    indices.data = buffers.view(sparse.index_view).data() + sparse.index_offset;
    indices.count = sparse.count;
    indices.component = sparse.index_type;
    indices.stride = byte_size(sparse.index_type);
    elements.replaced = read_integers(indices, buffers);
    elements.replacements = buffers.view(sparse.value_view).subspan(sparse.value_offset);
    const std::vector<std::uint32_t>& replaced = elements.replaced;
    if (std::adjacent_find(replaced.begin(), replaced.end(), std::greater_equal<>()) != replaced.end())
        throw BrokenContent("a sparse accessor's indices do not increase");
    if (replaced.back() >= elements.count)
        throw BrokenContent(
            fmt::format("a sparse accessor replaces element {} of {}", replaced.back(), elements.count));
}

}  // namespace

Elements open_accessor(const Accessor& accessor, Buffers& buffers) {
    Elements elements;
    elements.count = accessor.count;
    elements.components = accessor.components;
    elements.component = accessor.component;
    elements.normalized = accessor.normalized;
    if (accessor.view) {
        elements.data = buffers.view(*accessor.view).data() + accessor.offset;
        const std::uint32_t stride = buffers.stride(*accessor.view);
        elements.stride = stride > 0 ? stride : accessor.element_size;
    }
    if (accessor.sparse) open_sparse(*accessor.sparse, buffers, elements);
    return elements;
}

void read_floats(const Elements& elements, const Selection& selection, std::uint32_t components, std::span<float> out) {
    assert(out.size() == components * selection.size(elements.count));
    const std::uint32_t stored = std::min(components, elements.components);
    with_type(elements.component, [&](auto type) {
        using T = decltype(type);
        for_each_selected(selection, elements.count, [&](std::size_t place, std::size_t element) {
            float* const to = out.data() + place * components;
            if (elements.data == nullptr)
                std::fill_n(to, stored, 0.0F);
            else
                read_element<T>(elements.data + element * elements.stride, stored, elements.normalized, to);
        });
        for_each_replaced(elements, selection, [&](std::size_t place, const std::byte* replacement) {
            read_element<T>(replacement, stored, elements.normalized, out.data() + place * components);
        });
    });
}

std::vector<std::uint32_t> read_integers(const Elements& elements, Buffers& buffers) {
    buffers.spend(elements.count, sizeof(std::uint32_t));
    std::vector<std::uint32_t> values(elements.count);
    with_type(elements.component, [&](auto type) {
        using T = decltype(type);
        if constexpr (std::is_unsigned_v<T>) {
            if (elements.data != nullptr)
                for (std::size_t i = 0; i < values.size(); ++i)
                    values[i] = load<T>(elements.data + i * elements.stride);
            for_each_replaced(elements, {}, [&](std::size_t place, const std::byte* replacement) {
                values[place] = load<T>(replacement);
            });
        } else {
            assert(!"callers check the type");
        }
    });
    return values;
}

}  // namespace vmap::gltf
