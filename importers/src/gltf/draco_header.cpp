// SPDX-License-Identifier: GPL-3.0-or-later
#include "draco_header.h"

#include "../content_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace vmap::gltf {
namespace {

constexpr int deepest_metadata = 16;
constexpr std::uint32_t metadata_flag = 0x8000;

class ByteReader {
public:
    explicit ByteReader(std::span<const std::byte> bytes) : rest_(bytes) {}

    std::span<const std::byte> take(std::uint64_t count) {
        if (count > rest_.size()) throw BrokenContent("the Draco data end too early");
        const std::span<const std::byte> taken = rest_.first(count);
        rest_ = rest_.subspan(count);
        return taken;
    }
    std::uint32_t byte() { return std::to_integer<std::uint32_t>(take(1)[0]); }
    /// Seven bits a byte, lowest first; the eighth says that more follow.
    std::uint32_t varint() {
        std::uint64_t value = 0;
        for (unsigned shift = 0; shift < 35; shift += 7) {
            const std::uint32_t bits = byte();
            value |= static_cast<std::uint64_t>(bits & 0x7FU) << shift;
            if (bits < 0x80U && value <= 0xFFFFFFFF) return static_cast<std::uint32_t>(value);
        }
        throw BrokenContent("the Draco data hold a number of more than 32 bits");
    }

private:
    std::span<const std::byte> rest_;
};

/// Metadata are names with bytes and further metadata below them.
void skip_metadata(ByteReader& reader, int depth) {
    if (depth > deepest_metadata) throw BrokenContent("the Draco data have metadata nested too deep");
    for (std::uint32_t entries = reader.varint(); entries > 0; --entries) {
        reader.take(reader.byte());
        reader.take(reader.varint());
    }
    for (std::uint32_t parts = reader.varint(); parts > 0; --parts) {
        reader.take(reader.byte());
        skip_metadata(reader, depth + 1);
    }
}

void skip_all_metadata(ByteReader& reader) {
    for (std::uint32_t attributes = reader.varint(); attributes > 0; --attributes) {
        reader.varint();  // the attribute's id
        skip_metadata(reader, 0);
    }
    skip_metadata(reader, 0);
}

}  // namespace

DracoSizes read_draco_sizes(std::span<const std::byte> bytes) {
    constexpr std::string_view magic = "DRACO";
    constexpr std::uint32_t triangle_mesh = 1;
    ByteReader reader(bytes);
    const std::span<const std::byte> start = reader.take(magic.size());
    if (!std::equal(magic.begin(), magic.end(), start.begin(),
                    [](char c, std::byte b) { return static_cast<std::byte>(c) == b; }))
        throw BrokenContent("the compressed data are not of Draco");
    const std::uint32_t major_number = reader.byte();
    const std::uint32_t minor_number = reader.byte();
    if (major_number != 2 || minor_number != 2)
        throw UnsupportedContent(fmt::format("Draco data of version {}.{}, expected 2.2", major_number, minor_number));
    if (reader.byte() != triangle_mesh) throw BrokenContent("the Draco data do not hold triangles");
    const bool edgebreaker = reader.byte() == 1;
    const std::uint32_t flags = reader.byte() | reader.byte() << 8U;
    if ((flags & metadata_flag) != 0) skip_all_metadata(reader);

    DracoSizes sizes;
    if (edgebreaker) {
        reader.byte();    // the way of traversal
        reader.varint();  // vertices before attributes split them
        sizes.faces = reader.varint();
        sizes.points = 3 * sizes.faces;
    } else {
        sizes.faces = reader.varint();
        sizes.points = reader.varint();
    }
    return sizes;
}

}  // namespace vmap::gltf
