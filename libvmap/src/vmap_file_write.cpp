// SPDX-License-Identifier: Apache-2.0
#include "checksum.h"
#include "vmap_chunks.h"
#include "vmap_layout.h"

#include <cassert>
#include <cstring>

namespace vmap {
namespace {

template <class T>
std::span<const std::byte> bytes_of(const T& value) {
    static_assert(std::is_standard_layout_v<T>);
    return std::as_bytes(std::span(&value, 1));
}

/// Sends values on as they are; `send` counts, sums or writes them.
template <class Send>
class OutputArchive {
public:
    static constexpr bool reads = false;

    explicit OutputArchive(const Send& send) : send_(send) {}

    template <class T>
    void value(const T& v) {
        send_(bytes_of(v));
    }
    template <class T>
    void array(const T& values) {
        value(std::uint64_t{values.size()});
        send_(std::as_bytes(std::span(values)));
    }
    template <class T, class One>
    void list(const T& values, const One& one) {
        value(std::uint64_t{values.size()});
        for (const auto& v : values) one(v);
    }

private:
    const Send& send_;
};

/// Sends the bytes of a chunk's payload to `send`.
template <class Describe, class Send>
void send_payload(const Describe& describe, const VmapContents& contents, const Send& send) {
    OutputArchive<Send> archive(send);
    describe(archive, contents);
}

template <class Payload>
std::uint64_t size_of(const Payload& payload) {
    std::uint64_t size = 0;
    payload([&](std::span<const std::byte> bytes) { size += bytes.size(); });
    return size;
}

template <class Payload>
void write_chunk(const std::string& name, const Payload& payload, const ByteSink& sink) {
    ChunkHeader header{};
    std::memcpy(header.name.data(), name.data(), header.name.size());
    header.size = size_of(payload);
    Checksum checksum;
    const auto send = [&](std::span<const std::byte> bytes) {
        checksum.add(bytes);
        sink(bytes);
    };
    send(bytes_of(header));
    payload(send);
    sink(bytes_of(checksum.value()));
}

/// Calls visit(name, payload) for every chunk of the contents, where payload(send) sends its bytes.
template <class Visit>
void for_each_payload(const VmapContents& contents, const Visit& visit) {
    for_each_chunk([&](const std::string& name, const auto& describe) {
        visit(name, [&](const auto& send) { send_payload(describe, contents, send); });
    });
    for (const auto& chunk : contents.extra) {
        assert(chunk.first.size() == 4);
        visit(chunk.first, [&](const auto& send) { send(std::span(chunk.second)); });
    }
}

}  // namespace

void write_vmap(const VmapContents& contents, const ByteSink& sink) {
    FileHeader header;
    header.file_size = sizeof(FileHeader);
    for_each_payload(contents, [&](const std::string&, const auto& payload) {
        header.file_size += sizeof(ChunkHeader) + size_of(payload) + sizeof(std::uint64_t);
        ++header.chunks;
    });
    header.checksum = checksum_of(header);
    sink(bytes_of(header));
    for_each_payload(contents, [&](const std::string& name, const auto& payload) { write_chunk(name, payload, sink); });
}

}  // namespace vmap
