// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The bytes behind a document's buffers and views.
#pragma once

#include "../file_bytes.h"
#include "../scene_folder.h"
#include "document.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace vmap::gltf {

class Buffers {
public:
    /// Loads every buffer: from the GLB's binary chunk, a data URI or a file in the scene's folder.
    ///
    /// - bin: the binary chunk; has to outlive this object
    /// - throws BrokenContent when a file is not there or shorter than the document says
    Buffers(const Document& document, const SceneFolder& folder, std::optional<std::span<const std::byte>> bin);

    /// Bytes of a view; a compressed one is decompressed at the first call.
    /// - throws BrokenContent for a view of a buffer that has none, and for damaged compressed bytes
    [[nodiscard]] std::span<const std::byte> view(std::size_t index);

    /// Bytes between the elements of a view; 0 when they follow each other.
    [[nodiscard]] std::uint32_t stride(std::size_t view) const;

    /// Asks for memory before it is taken. What a document may take in all depends on its size, so that a short file
    /// cannot claim much by naming the same bytes again and again.
    ///
    /// - throws UnsupportedContent when it asks for too much
    void spend(std::uint64_t count, std::uint64_t bytes_each);

private:
    [[nodiscard]] std::span<const std::byte> range(std::size_t buffer, std::uint64_t offset,
                                                   std::uint64_t length) const;

    const Document& document_;
    std::vector<Bytes> owned_;
    std::vector<std::optional<std::span<const std::byte>>> buffers_;
    std::vector<std::optional<Bytes>> decompressed_;  // one per view
    std::uint64_t budget_ = 0;                        // bytes that may still be taken
};

}  // namespace vmap::gltf
