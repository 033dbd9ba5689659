// SPDX-License-Identifier: GPL-3.0-or-later
#include "container.h"

#include "../content_error.h"
#include "../file_bytes.h"

#include <fmt/format.h>

#include <cstdint>

namespace vmap::gltf {
namespace {

constexpr std::uint32_t glb_magic = 0x46546C67;   // "glTF"
constexpr std::uint32_t json_chunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t bin_chunk = 0x004E4942;   // "BIN\0"
constexpr std::size_t header_size = 12;
constexpr std::size_t chunk_header_size = 8;

/// The little-endian word at an offset that the caller has checked.
std::uint32_t word_at(std::span<const std::byte> bytes, std::size_t offset) {
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < 4; ++i) word |= std::to_integer<std::uint32_t>(bytes[offset + i]) << (8 * i);
    return word;
}

struct Chunk {
    std::uint32_t type = 0;
    std::span<const std::byte> data;
};

/// Takes the next chunk off the front of what is left of the file.
Chunk take_chunk(std::span<const std::byte>& rest) {
    if (rest.size() < chunk_header_size) throw BrokenContent("the GLB ends inside the header of a chunk");
    const std::uint32_t length = word_at(rest, 0);
    const std::size_t available = rest.size() - chunk_header_size;
    if (length > available)
        throw BrokenContent(fmt::format("a GLB chunk claims {} bytes, but the file has {} left", length, available));
    if (length % 4 != 0) throw BrokenContent(fmt::format("a GLB chunk has {} bytes, expected a multiple of 4", length));
    const Chunk chunk{word_at(rest, 4), rest.subspan(chunk_header_size, length)};
    rest = rest.subspan(chunk_header_size + length);
    return chunk;
}

Container open_glb(std::span<const std::byte> file) {
    if (file.size() < header_size) throw BrokenContent("the GLB ends inside its header");
    const std::uint32_t version = word_at(file, 4);
    if (version != 2) throw BrokenContent(fmt::format("GLB version {}, expected 2", version));
    const std::uint32_t length = word_at(file, 8);
    if (length != file.size())
        throw BrokenContent(fmt::format("the GLB claims {} bytes, but the file has {}", length, file.size()));

    std::span<const std::byte> rest = file.subspan(header_size);
    const Chunk json = take_chunk(rest);
    if (json.type != json_chunk || json.data.empty()) throw BrokenContent("the first GLB chunk is not a JSON text");
    Container container{.json = as_text(json.data), .bin = std::nullopt, .is_glb = true};
    for (bool second = true; !rest.empty(); second = false) {
        const Chunk chunk = take_chunk(rest);
        if (chunk.type == json_chunk) throw BrokenContent("the GLB has two JSON chunks");
        if (chunk.type != bin_chunk) continue;  // the specification asks to ignore chunks of other types
        if (!second) throw BrokenContent("the GLB's binary chunk is not the second one");
        container.bin = chunk.data;
    }
    return container;
}

}  // namespace

Container open_container(std::span<const std::byte> file) {
    if (file.empty()) throw BrokenContent("the file is empty");
    if (file.size() >= 4 && word_at(file, 0) == glb_magic) return open_glb(file);
    return {.json = as_text(file), .bin = std::nullopt, .is_glb = false};
}

}  // namespace vmap::gltf
