// SPDX-License-Identifier: GPL-3.0-or-later
#include "buffers.h"

#include "../content_error.h"
#include "../uri.h"
#include "limits.h"
#include "meshopt.h"

#include <fmt/format.h>

#include <cassert>

namespace vmap::gltf {
namespace {

/// A URI in a message: data URIs are long.
std::string shortened(const std::string& uri) {
    constexpr std::size_t longest = 60;
    return uri.size() > longest ? uri.substr(0, longest) + "..." : uri;
}

Bytes load(const std::string& uri, std::uint64_t length, const SceneFolder& folder) {
    if (std::optional<Bytes> embedded = bytes_from_data_uri(uri)) return std::move(*embedded);
    return read_file_start(folder.find(path_from_uri(uri)), length);
}

}  // namespace

Buffers::Buffers(const Document& document, const SceneFolder& folder, std::optional<std::span<const std::byte>> bin)
    : document_(document), buffers_(document.buffers.size()), decompressed_(document.views.size()) {
    std::uint64_t stored = 0;
    for (std::size_t i = 0; i < buffers_.size(); ++i) {
        const BufferInfo& info = document.buffers[i];
        if (info.fallback) continue;
        if (info.uri) {
            try {
                owned_.push_back(load(*info.uri, info.length, folder));
            } catch (const BrokenContent& error) {
                throw BrokenContent(fmt::format("buffers[{}] '{}': {}", i, shortened(*info.uri), error.what()));
            }
            buffers_[i] = owned_.back().span();
        } else if (i == 0) {
            buffers_[i] = bin;
        } else {
            throw BrokenContent(fmt::format("buffers[{}] has no uri: only the first buffer of a GLB may have none", i));
        }
        std::optional<std::span<const std::byte>>& bytes = buffers_[i];
        if (!bytes) continue;
        if (bytes->size() < info.length)
            throw BrokenContent(
                fmt::format("buffers[{}] has {} bytes, but its byteLength is {}", i, bytes->size(), info.length));
        bytes = bytes->first(info.length);
        stored += info.length;
    }
    budget_ = unstored_bytes + stored * most_bytes_per_stored_byte;
}

std::span<const std::byte> Buffers::range(std::size_t buffer, std::uint64_t offset, std::uint64_t length) const {
    const std::optional<std::span<const std::byte>>& bytes = buffers_[buffer];
    if (!bytes) throw BrokenContent(fmt::format("buffers[{}] has no bytes: neither a uri nor a binary chunk", buffer));
    assert(offset + length <= bytes->size());  // checked when the document was read
    return bytes->subspan(offset, length);
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
