// SPDX-License-Identifier: Apache-2.0
/// \file
/// Random numbers without state: a hash of (seed, index), and a low-discrepancy sequence in the square.
///
/// This work is based on:
///   S. Vigna, splitmix64 (the finaliser);
///   M. Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018 (R2).
#pragma once

#include <Imath/ImathVec.h>

#include <cmath>
#include <cstdint>
#include <numbers>

namespace vmap {

[[nodiscard]] constexpr std::uint64_t hash64(std::uint64_t x) {
    x += 0x9E3779B97F4A7C15ULL;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
    return x ^ (x >> 31);
}

/// Point i of the R2 sequence in [0, 1)^2, shifted by a key.
[[nodiscard]] inline Imath::V2d shifted_r2(std::uint64_t key, std::uint32_t i) {
    const std::uint64_t shift = hash64(key);
    const double u = 0.7548776662466927 * i + static_cast<double>(shift >> 32) * 0x1p-32;
    const double v = 0.5698402909980532 * i + static_cast<double>(shift & 0xFFFFFFFFU) * 0x1p-32;
    return {u - std::floor(u), v - std::floor(v)};
}

/// A direction over +z with a density proportional to its cosine.
[[nodiscard]] inline Imath::V3d cosine_direction(const Imath::V2d& sample) {
    const double radius = std::sqrt(sample.x);
    const double angle = 2 * std::numbers::pi * sample.y;
    return {radius * std::cos(angle), radius * std::sin(angle), std::sqrt(1 - sample.x)};
}

}  // namespace vmap
