// SPDX-License-Identifier: GPL-3.0-or-later
#include "buffers.h"

#include "../content_error.h"
#include "../uri.h"
#include "limits.h"
#include "meshopt.h"

#include <fmt/format.h>

#include <cassert>
#include <numeric>

namespace vmap::gltf {
namespace {

/// A URI in a message: data URIs are long.
std::string shortened(const std::string& uri) {
    constexpr std::size_t longest = 60;
    return uri.size() > longest ? uri.substr(0, longest) + "..." : uri;
}

Bytes load(const BufferInfo& info, const SceneFolder& folder) {
    if (std::optional<Bytes> embedded = bytes_from_data_uri(*info.uri)) return std::move(*embedded);
    return read_file_start(folder.find(path_from_uri(*info.uri)), info.length);
}

}  // namespace

Buffers::Buffers(const Document& document, const SceneFolder& folder, std::optional<std::span<const std::byte>> bin)
    : document_(document), decompressed_(document.views.size()) {
    for (std::size_t i = 0; i < document.buffers.size(); ++i) {
        const BufferInfo& info = document.buffers[i];
        std::span<const std::byte> bytes;
        if (info.uri && !info.placeholder) {
            try {
                owned_.push_back(load(info, folder));
            } catch (const BrokenContent& error) {
                throw BrokenContent(fmt::format("buffers[{}] '{}': {}", i, shortened(*info.uri), error.what()));
            }
            bytes = owned_.back().span();
        } else if (!info.placeholder) {
            if (!bin) throw BrokenContent(fmt::format("buffers[{}] has neither a uri nor a binary chunk", i));
            bytes = *bin;
        }
        if (!info.placeholder && bytes.size() < info.length)
            throw BrokenContent(
                fmt::format("buffers[{}] has {} bytes, but its byteLength is {}", i, bytes.size(), info.length));
        buffers_.push_back(info.placeholder ? bytes : bytes.first(info.length));
    }
    const std::uint64_t stored =
        std::accumulate(buffers_.begin(), buffers_.end(), std::uint64_t{0},
                        [](std::uint64_t sum, const auto& buffer) { return sum + buffer.size(); });
    budget_ = unstored_bytes + stored * most_bytes_per_stored_byte;
}

std::span<const std::byte> Buffers::range(std::size_t buffer, std::uint64_t offset, std::uint64_t length) const {
    if (document_.buffers[buffer].placeholder)
        throw BrokenContent(
            fmt::format("buffers[{}] has no bytes of its own and is read without decompression", buffer));
    assert(offset + length <= buffers_[buffer].size());  // checked when the document was read
    return buffers_[buffer].subspan(offset, length);
}

std::span<const std::byte> Buffers::view(std::size_t index) {
    const BufferView& view = document_.views[index];
    if (!view.meshopt) return range(view.buffer, view.offset, view.length);
    std::optional<Bytes>& bytes = decompressed_[index];
    if (!bytes) {
        const MeshoptView& packed = *view.meshopt;
        spend(packed.count, packed.stride);
        try {
            bytes = decompress_meshopt(packed, range(packed.buffer, packed.offset, packed.length));
        } catch (const BrokenContent& error) {
            throw BrokenContent(fmt::format("bufferViews[{}]: {}", index, error.what()));
        }
        if (bytes->size() < view.length)
            throw BrokenContent(fmt::format("bufferViews[{}] decompresses to {} bytes, but its byteLength is {}", index,
                                            bytes->size(), view.length));
    }
    return bytes->span().first(view.length);
}

std::uint32_t Buffers::stride(std::size_t view) const {
    return document_.views[view].stride;
}

void Buffers::spend(std::uint64_t count, std::uint64_t bytes_each) {
    if (count > budget_ / bytes_each)
        throw UnsupportedContent("its meshes would take far more memory than a file of its size may ask for");
    budget_ -= count * bytes_each;
}

}  // namespace vmap::gltf
