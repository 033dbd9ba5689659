// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Random numbers without state: a hash of what they are for, so that they do not depend on the order of the work.
///
/// This work is based on:
///   G. Steele, D. Lea, C. Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014 (splitmix64).
#pragma once

#include <cstdint>

namespace vmap {

[[nodiscard]] constexpr std::uint64_t hash_bits(std::uint64_t x) {
    x += 0x9E3779B97F4A7C15ULL;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
    return x ^ (x >> 31);
}

[[nodiscard]] constexpr std::uint64_t hash_bits(std::uint64_t a, std::uint64_t b) {
    return hash_bits(hash_bits(a) ^ b);
}

/// The upper and the lower half of a hash as numbers in [0, 1).
[[nodiscard]] constexpr double upper_unit(std::uint64_t hash) {
    return static_cast<double>(hash >> 32) * 0x1p-32;
}
[[nodiscard]] constexpr double lower_unit(std::uint64_t hash) {
    return static_cast<double>(hash & 0xFFFFFFFFU) * 0x1p-32;
}

}  // namespace vmap
