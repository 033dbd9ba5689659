// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Points of Sobol's sequence in the square, in random order and randomly scrambled, from a key and an index alone.
///
/// This work is based on:
///   B. Burley, "Practical hash-based Owen scrambling", JCGT 2020;
///   S. Laine, T. Karras, "Stratified sampling for stochastic transparency", EGSR 2011 (the hash that keeps strata).
#pragma once

#include <Imath/ImathVec.h>

#include <cstdint>

namespace vmap::reference {

/// Mixes two keys into one (the finaliser of MurmurHash3 by A. Appleby on their combination).
[[nodiscard]] constexpr std::uint64_t mix_keys(std::uint64_t a, std::uint64_t b) {
    std::uint64_t x = a ^ (b * 0xD6E8FEB86659FD93ULL + 0x2545F4914F6CDD1DULL + (a << 7) + (a >> 3));
    x = (x ^ (x >> 33)) * 0xFF51AFD7ED558CCDULL;
    x = (x ^ (x >> 33)) * 0xC4CEB9FE1A85EC53ULL;
    return x ^ (x >> 33);
}

[[nodiscard]] constexpr std::uint32_t reverse_bits(std::uint32_t x) {
    x = ((x >> 1) & 0x55555555U) | ((x & 0x55555555U) << 1);
    x = ((x >> 2) & 0x33333333U) | ((x & 0x33333333U) << 2);
    x = ((x >> 4) & 0x0F0F0F0FU) | ((x & 0x0F0F0F0FU) << 4);
    x = ((x >> 8) & 0x00FF00FFU) | ((x & 0x00FF00FFU) << 8);
    return (x >> 16) | (x << 16);
}

/// Owen's scrambling: each bit is flipped or not depending on the bits above it.
[[nodiscard]] constexpr std::uint32_t scramble_bits(std::uint32_t x, std::uint32_t key) {
    x = reverse_bits(x) + key;
    x ^= x * 0x6C50B47CU;
    x ^= x * 0xB82F1E52U;
    x ^= x * 0xC7AFE638U;
    x ^= x * 0x8D22F6E6U;
    return reverse_bits(x);
}

/// Second component of Sobol's sequence, as bits behind the binary point; the first is reverse_bits(index).
[[nodiscard]] constexpr std::uint32_t sobol_second(std::uint32_t index) {
    std::uint32_t result = 0;
    for (std::uint32_t direction = 1U << 31; index != 0; index >>= 1, direction ^= direction >> 1)
        if ((index & 1U) != 0) result ^= direction;
    return result;
}

/// Point `index` of the key's own scrambled sequence in [0, 1)^2. Sequences of different keys are independent.
[[nodiscard]] inline Imath::V2d scrambled_sobol(std::uint64_t key, std::uint32_t index) {
    const std::uint64_t more = mix_keys(key, 1);
    const std::uint32_t i = scramble_bits(index, static_cast<std::uint32_t>(key));
    const std::uint32_t x = scramble_bits(reverse_bits(i), static_cast<std::uint32_t>(more));
    const std::uint32_t y = scramble_bits(sobol_second(i), static_cast<std::uint32_t>(more >> 32));
    return {x * 0x1p-32, y * 0x1p-32};
}

}  // namespace vmap::reference
