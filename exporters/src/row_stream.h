// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Rows of binary data laid out by all threads and handed on in order, with a bounded amount of memory.
#pragma once

#include <Imath/ImathVec.h>
#include <tbb/parallel_pipeline.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <type_traits>
#include <vector>

namespace vmap {

static_assert(std::endian::native == std::endian::little, "rows are copied as they lie in memory");

/// Lays out rows one after the other.
class RowBuffer {
public:
    explicit RowBuffer(std::size_t size) : bytes_(size) {}

    template <class T>
        requires std::is_arithmetic_v<T>
    void put(T value) {
        std::memcpy(bytes_.data() + used_, &value, sizeof value);
        used_ += sizeof value;
    }
    void put(const Imath::V3f& value) {
        put(value.x);
        put(value.y);
        put(value.z);
    }

    void clear() { used_ = 0; }
    [[nodiscard]] const char* data() const { return bytes_.data(); }
    [[nodiscard]] std::size_t size() const { return used_; }

private:
    std::vector<char> bytes_;
    std::size_t used_ = 0;
};

/// Calls put_row(RowBuffer&, i) for each i below count, from many threads, and sink(data, size, rows so far) with the
/// rows in order, from one thread at a time.
///
/// - row_size: bytes that put_row puts for each row
template <class PutRow, class Sink>
void stream_rows(std::size_t count, std::size_t row_size, const PutRow& put_row, const Sink& sink) {
    constexpr std::size_t rows_per_chunk = 16384;
    constexpr std::size_t chunks_in_flight = 8;
    struct Chunk {
        std::size_t begin = 0;
        std::size_t end = 0;
        RowBuffer* rows = nullptr;
    };

    // Chunks go round a ring of buffers: at most chunks_in_flight of them are alive, and they leave in order.
    std::vector<RowBuffer> ring(chunks_in_flight, RowBuffer(std::min(count, rows_per_chunk) * row_size));
    std::size_t next = 0;
    const auto take = [&](tbb::flow_control& flow) {
        if (next >= count) flow.stop();
        const Chunk chunk{next, std::min(next + rows_per_chunk, count), &ring[next / rows_per_chunk % ring.size()]};
        next = chunk.end;
        return chunk;
    };
    const auto lay_out = [&](const Chunk& chunk) {
        chunk.rows->clear();
        for (std::size_t i = chunk.begin; i < chunk.end; ++i) put_row(*chunk.rows, i);
        return chunk;
    };
    const auto hand_on = [&](const Chunk& chunk) { sink(chunk.rows->data(), chunk.rows->size(), chunk.end); };
    using tbb::filter_mode;
    tbb::parallel_pipeline(chunks_in_flight, tbb::make_filter<void, Chunk>(filter_mode::serial_in_order, take) &
                                                 tbb::make_filter<Chunk, Chunk>(filter_mode::parallel, lay_out) &
                                                 tbb::make_filter<Chunk, void>(filter_mode::serial_in_order, hand_on));
}

}  // namespace vmap
