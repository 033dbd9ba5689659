// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The header of a PLY file: what elements follow and how their values are laid out.
///
/// Source: G. Turk, "The PLY polygon file format", 1994; type names with sizes (int8, float32) as later writers have
/// them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vmap {

enum class PlyEncoding { ascii, little_endian, big_endian };

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Bytes of one value in a binary file.
[[nodiscard]] std::size_t size_of(PlyType type);

[[nodiscard]] bool is_integer(PlyType type);

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::float32;     ///< of the value, or of the values of a list
    std::optional<PlyType> length_type;  ///< of the length in front of a list; nothing for a single value

    [[nodiscard]] bool is_list() const { return length_type.has_value(); }
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;

    /// Place of a property; nothing when there is none of that name.
    [[nodiscard]] std::optional<std::size_t> find(std::string_view property) const;
};

struct PlyHeader {
    PlyEncoding encoding = PlyEncoding::ascii;
    std::vector<PlyElement> elements;
    std::vector<std::string> comments;  ///< without the word "comment"
    std::size_t size = 0;               ///< bytes up to the first element
    std::size_t lines = 0;

    [[nodiscard]] const PlyElement* find(std::string_view element) const;
};

/// - text: of the whole file
/// - throws BrokenContent for anything that is not a complete header
[[nodiscard]] PlyHeader read_ply_header(std::string_view text);

}  // namespace vmap
