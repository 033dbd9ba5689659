// SPDX-License-Identifier: Apache-2.0
#include <vmap/sky.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace vmap {

using Imath::C3f;

std::size_t Sky::at(const Imath::V3f& direction) const {
    constexpr float pi = std::numbers::pi_v<float>;
    const float along = std::atan2(direction.z, direction.x) / (2 * pi) + 0.5F;
    const float down = std::acos(std::clamp(direction.normalized().y, -1.0F, 1.0F)) / pi;
    const int x = std::clamp(static_cast<int>(along * static_cast<float>(width)), 0, width - 1);
    const int y = std::clamp(static_cast<int>(down * static_cast<float>(height)), 0, height - 1);
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
}

Sky even_sky(const C3f& radiance) {
    return {1, 1, {radiance}};
}

Sky sky_of_panorama(std::span<const C3f> pixels, int width, int height, int most_width) {
    Sky sky{std::min(width, most_width), std::min(height, std::max(most_width / 2, 1)), {}};
    sky.radiance.assign(static_cast<std::size_t>(sky.width) * static_cast<std::size_t>(sky.height), C3f(0, 0, 0));
    std::vector<float> counts(sky.radiance.size(), 0.0F);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto row = static_cast<std::size_t>(std::int64_t{y} * sky.height / height);
            const auto column = static_cast<std::size_t>(std::int64_t{x} * sky.width / width);
            const std::size_t bin = row * static_cast<std::size_t>(sky.width) + column;
            const C3f& pixel =
                pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
            for (int c = 0; c < 3; ++c) sky.radiance[bin][c] += std::max(pixel[c], 0.0F);
            counts[bin] += 1;
        }
    for (std::size_t i = 0; i < counts.size(); ++i) sky.radiance[i] /= counts[i];
    return sky;
}

}  // namespace vmap
