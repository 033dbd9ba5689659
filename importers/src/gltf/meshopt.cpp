// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshopt.h"

#include "../content_error.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

namespace vmap::gltf {
namespace {

void check(bool sound, const char* expected) {
    if (!sound) throw BrokenContent(fmt::format("EXT_meshopt_compression expected {}", expected));
}

void check_numbers(const MeshoptView& view) {
    switch (view.mode) {
        case MeshoptMode::attributes:
            check(view.stride % 4 == 0, "a byteStride that is a multiple of 4");
            break;
        case MeshoptMode::triangles:
            check(view.count % 3 == 0, "a count that is a multiple of 3");
            [[fallthrough]];
        case MeshoptMode::indices:
            check(view.stride == 2 || view.stride == 4, "a byteStride of 2 or 4 for indices");
            check(view.filter == MeshoptFilter::none, "no filter for indices");
            break;
    }
    if (view.filter == MeshoptFilter::octahedral)
        check(view.stride == 4 || view.stride == 8, "a byteStride of 4 or 8 for the octahedral filter");
    if (view.filter == MeshoptFilter::quaternion)
        check(view.stride == 8, "a byteStride of 8 for the quaternion filter");
}

int decode(const MeshoptView& view, std::span<const std::byte> compressed, std::byte* out) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(compressed.data());
    switch (view.mode) {
        case MeshoptMode::triangles:
            return meshopt_decodeIndexBuffer(out, view.count, view.stride, bytes, compressed.size());
        case MeshoptMode::indices:
            return meshopt_decodeIndexSequence(out, view.count, view.stride, bytes, compressed.size());
        default:
            return meshopt_decodeVertexBuffer(out, view.count, view.stride, bytes, compressed.size());
    }
}

void undo_filter(const MeshoptView& view, std::byte* bytes) {
    switch (view.filter) {
        case MeshoptFilter::none:
            return;
        case MeshoptFilter::octahedral:
            return meshopt_decodeFilterOct(bytes, view.count, view.stride);
        case MeshoptFilter::quaternion:
            return meshopt_decodeFilterQuat(bytes, view.count, view.stride);
        case MeshoptFilter::exponential:
            return meshopt_decodeFilterExp(bytes, view.count, view.stride);
    }
}

}  // namespace

Bytes decompress_meshopt(const MeshoptView& view, std::span<const std::byte> compressed) {
    check_numbers(view);
    Bytes bytes(view.count * view.stride);
    if (decode(view, compressed, bytes.data()) != 0) throw BrokenContent("its compressed bytes are damaged");
    undo_filter(view, bytes.data());
    return bytes;
}

}  // namespace vmap::gltf
