// SPDX-License-Identifier: Apache-2.0
#include "gather_directions.h"

#include "sampling.h"

#include <bit>
#include <cassert>

namespace vmap {
namespace {

/// Radical inverse in base 2, as a 32-bit fraction.
std::uint32_t van_der_corput(std::uint32_t i) {
    i = (i << 16) | (i >> 16);
    i = ((i & 0x00FF00FFU) << 8) | ((i & 0xFF00FF00U) >> 8);
    i = ((i & 0x0F0F0F0FU) << 4) | ((i & 0xF0F0F0F0U) >> 4);
    i = ((i & 0x33333333U) << 2) | ((i & 0xCCCCCCCCU) >> 2);
    return ((i & 0x55555555U) << 1) | ((i & 0xAAAAAAAAU) >> 1);
}

/// Second dimension of Sobol's sequence, as a 32-bit fraction.
std::uint32_t sobol_second(std::uint32_t i) {
    std::uint32_t result = 0;
    for (std::uint32_t v = 1U << 31; i != 0; i >>= 1, v ^= v >> 1)
        if ((i & 1U) != 0) result ^= v;
    return result;
}

}  // namespace

GatherDirections::GatherDirections(std::uint32_t size, std::uint64_t seed) : size_(size) {
    assert(std::has_single_bit(size) && size >= 8);
    const std::uint64_t shift = hash64(seed);
    // Runs of a power of two of the sequence are nets, and so is the whole of them. The shift is digital.
    for (std::uint32_t i = 0; i < size * set_count; ++i) {
        const std::uint32_t u = van_der_corput(i) ^ static_cast<std::uint32_t>(shift >> 32);
        const std::uint32_t v = sobol_second(i) ^ static_cast<std::uint32_t>(shift);
        const Imath::V3f direction(cosine_direction({(u + 0.5) * 0x1p-32, (v + 0.5) * 0x1p-32}));
        x_.push_back(direction.x);
        y_.push_back(direction.y);
        z_.push_back(direction.z);
    }
}

}  // namespace vmap
