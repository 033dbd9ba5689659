// SPDX-License-Identifier: Apache-2.0
/// \file
/// Directions that irradiance is gathered along: cosine-distributed sets that are well spread each for itself and
/// together, so that neighbouring receivers with different sets add up to one finer set when they are smoothed.
///
/// This work is based on:
///   I. M. Sobol', "On the distribution of points in a cube and the approximate evaluation of integrals", 1967;
///   A. Keller, W. Heidrich, "Interleaved sampling", EGWR 2001.
#pragma once

#include <Imath/ImathVec.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vmap {

/// Right-handed frame whose z is a normal.
struct NormalFrame {
    Imath::V3f x;
    Imath::V3f y;
    Imath::V3f z;

    explicit NormalFrame(const Imath::V3f& normal)
        : x(normal.cross(std::abs(normal.x) < 0.6F ? Imath::V3f(1, 0, 0) : Imath::V3f(0, 1, 0)).normalized()),
          y(normal.cross(x)),
          z(normal) {}

    [[nodiscard]] Imath::V3f world_from_local(const Imath::V3f& v) const { return x * v.x + y * v.y + z * v.z; }
    [[nodiscard]] Imath::V3f local_from_world(const Imath::V3f& v) const { return {x.dot(v), y.dot(v), z.dot(v)}; }
};

/// Directions as one array per coordinate, so that many can be worked on at once.
struct DirectionSet {
    std::span<const float> x;
    std::span<const float> y;
    std::span<const float> z;

    [[nodiscard]] std::size_t size() const { return x.size(); }
    [[nodiscard]] Imath::V3f operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
};

class GatherDirections {
public:
    static constexpr std::uint32_t set_count = 16;

    /// - size: directions of one set, a power of two and at least 8
    GatherDirections(std::uint32_t size, std::uint64_t seed);

    [[nodiscard]] std::uint32_t size() const { return size_; }

    /// One set, around +z.
    [[nodiscard]] DirectionSet set(std::uint32_t index) const {
        const auto part = [&](const std::vector<float>& all) {
            return std::span(all).subspan(std::size_t{index % set_count} * size_, size_);
        };
        return {part(x_), part(y_), part(z_)};
    }

private:
    std::uint32_t size_;
    std::vector<float> x_;
    std::vector<float> y_;
    std::vector<float> z_;
};

}  // namespace vmap
