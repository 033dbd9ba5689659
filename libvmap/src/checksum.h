// SPDX-License-Identifier: Apache-2.0
/// \file
/// Checksum of a stream of bytes, the same however the stream is cut into pieces. Every step is a bijection of the
/// word that it takes in, so that a change within one word never goes unseen.
#pragma once

#include "sampling.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace vmap {

class Checksum {
public:
    void add(std::span<const std::byte> bytes) {
        length_ += bytes.size();
        if (waiting_ > 0) {
            const std::size_t taken = std::min(bytes.size(), block_size - waiting_);
            std::memcpy(block_.data() + waiting_, bytes.data(), taken);
            waiting_ += taken;
            bytes = bytes.subspan(taken);
            if (waiting_ < block_size) return;
            mix(block_.data());
            waiting_ = 0;
        }
        for (; bytes.size() >= block_size; bytes = bytes.subspan(block_size)) mix(bytes.data());
        if (!bytes.empty()) std::memcpy(block_.data(), bytes.data(), bytes.size());
        waiting_ = bytes.size();
    }

    [[nodiscard]] std::uint64_t value() const {
        Checksum last = *this;
        std::memset(last.block_.data() + waiting_, 0, block_size - waiting_);
        last.mix(last.block_.data());
        std::uint64_t result = hash64(length_);
        for (const std::uint64_t lane : last.lanes_) result = hash64(result ^ lane);
        return result;
    }

private:
    static constexpr std::size_t block_size = 32;

    void mix(const std::byte* block) {
        for (std::size_t lane = 0; lane < lanes_.size(); ++lane) {
            std::uint64_t word = 0;
            std::memcpy(&word, block + 8 * lane, 8);
            const std::uint64_t turned = (lanes_[lane] ^ word) * 0x9E3779B97F4A7C15ULL;
            lanes_[lane] = turned << 29 | turned >> 35;
        }
    }

    std::array<std::uint64_t, 4> lanes_{1, 2, 3, 4};
    std::array<std::byte, block_size> block_{};
    std::size_t waiting_ = 0;
    std::uint64_t length_ = 0;
};

}  // namespace vmap
