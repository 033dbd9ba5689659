// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Elements of accessors as floats and integers: strided, sparse, normalised or quantised.
#pragma once

#include "buffers.h"
#include "document.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vmap::gltf {

/// Where the elements of one attribute lie in memory. Built from an accessor or from a decoded compressed mesh.
struct Elements {
    const std::byte* data = nullptr;  ///< first element; null for zeros
    std::uint64_t count = 0;
    std::uint32_t stride = 0;  ///< bytes from one element to the next
    std::uint32_t components = 1;
    ComponentType component = ComponentType::float32;
    bool normalized = false;

    /// Sparse replacements: strictly increasing element numbers, and one packed element for each.
    std::vector<std::uint32_t> replaced;
    std::span<const std::byte> replacements;
};

/// Finds the bytes of an accessor. Takes no memory for elements that are not stored.
///
/// - throws BrokenContent when its sparse indices are not increasing or not below its count
[[nodiscard]] Elements open_accessor(const Accessor& accessor, Buffers& buffers);

/// Vertices to read: all, or some in increasing order.
struct Selection {
    bool all = true;
    std::vector<std::uint32_t> chosen;

    [[nodiscard]] std::size_t size(std::uint64_t count) const { return all ? count : chosen.size(); }
};

/// Reads elements as floats, normalised integers mapped to [-1, 1] or [0, 1].
///
/// - components: written per element; missing ones keep what out holds, further ones are left out
/// - out: components floats for each selected element
void read_floats(const Elements& elements, const Selection& selection, std::uint32_t components, std::span<float> out);

/// Reads scalars of an unsigned type.
///
/// - buffers: asked for the memory that they take
[[nodiscard]] std::vector<std::uint32_t> read_integers(const Elements& elements, Buffers& buffers);

}  // namespace vmap::gltf
