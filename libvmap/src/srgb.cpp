// SPDX-License-Identifier: Apache-2.0
#include <vmap/srgb.h>

#include <array>
#include <bit>
#include <cmath>

namespace vmap {
namespace {

double linear_from_encoded(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

/// Light below this rounds to sample 0.
constexpr float darkest = 0x1p-13F;

/// Buckets of equal exponent and upper 7 bits of the mantissa: narrower than the steps between samples.
constexpr int bucket_shift = 16;
constexpr std::uint32_t first_bucket = std::bit_cast<std::uint32_t>(darkest) >> bucket_shift;
constexpr std::uint32_t bucket_count = (std::bit_cast<std::uint32_t>(1.0F) >> bucket_shift) - first_bucket;

struct Tables {
    std::array<float, 256> linear{};       ///< light of each sample
    std::array<float, 256> upper_bound{};  ///< least light that rounds to the next sample; the last is never reached
    std::array<std::uint8_t, bucket_count> start{};  ///< sample of the least light in a bucket

    Tables() {
        for (int i = 0; i < 256; ++i) {
            linear[i] = static_cast<float>(linear_from_encoded(i / 255.0));
            upper_bound[i] = i < 255 ? static_cast<float>(linear_from_encoded((i + 0.5) / 255.0)) : 2.0F;
        }
        int sample = 0;
        for (std::uint32_t bucket = 0; bucket < bucket_count; ++bucket) {
            const auto least = std::bit_cast<float>((first_bucket + bucket) << bucket_shift);
            while (least >= upper_bound[sample]) ++sample;
            start[bucket] = static_cast<std::uint8_t>(sample);
        }
    }
};

const Tables& tables() {
    static const Tables instance;
    return instance;
}

}  // namespace

float linear_from_srgb8(std::uint8_t sample) {
    return tables().linear[sample];
}

float linear_from_srgb(float encoded) {
    if (!(encoded > 0)) return 0;
    return encoded >= 1 ? 1 : static_cast<float>(linear_from_encoded(encoded));
}

std::uint8_t srgb8_from_linear(float linear) {
    if (!(linear >= darkest)) return 0;
    if (linear >= 1) return 255;
    const Tables& t = tables();
    int sample = t.start[(std::bit_cast<std::uint32_t>(linear) >> bucket_shift) - first_bucket];
    while (linear >= t.upper_bound[sample]) ++sample;
    return static_cast<std::uint8_t>(sample);
}

}  // namespace vmap
