// SPDX-License-Identifier: Apache-2.0
/// \file
/// The frame of a .vmap file: a header, then chunks. A chunk is its header, its payload and the checksum of both.
#pragma once

#include "checksum.h"

#include <vmap/vmap_file.h>

#include <array>
#include <cstdint>
#include <span>

namespace vmap {

struct FileHeader {
    std::array<char, 8> magic{'V', 'M', 'A', 'P', '\r', '\n', '\x1a', '\n'};  ///< shows damage by text transfers too
    std::uint32_t version = vmap_file_version;
    std::uint32_t chunks = 0;
    std::uint64_t file_size = 0;
    std::uint64_t checksum = 0;  ///< of what stands before it
};
static_assert(sizeof(FileHeader) == 32);

struct ChunkHeader {
    std::array<char, 4> name;
    std::uint32_t reserved;  ///< 0
    std::uint64_t size;      ///< of the payload, bytes
};
static_assert(sizeof(ChunkHeader) == 16);

[[nodiscard]] inline std::uint64_t checksum_of(const FileHeader& header) {
    Checksum checksum;
    checksum.add(std::as_bytes(std::span(&header, 1)).first(offsetof(FileHeader, checksum)));
    return checksum.value();
}

}  // namespace vmap
