// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The surface of a scene as oriented points.
#pragma once

#include <vmap/point_cloud.h>
#include <vmap/progress.h>
#include <vmap/scene.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vmap {

enum class SamplePattern {
    blue_noise,  ///< evenly spread: within flat parts no two points are nearer than 0.6 of the mean spacing
    stratified   ///< one point at random in each of equal pieces of surface: faster, uneven
};

enum class SampleNormals {
    geometric,  ///< of the triangle: what irradiance is defined over
    shading     ///< interpolated from the vertices
};

enum class SampleSides {
    automatic,  ///< the front of every surface; the back of double-sided ones too, but for the inside of closed parts
    front,
    both
};

struct SampleConfig {
    std::optional<std::size_t> points;  ///< how many; default_points when neither this nor spacing is given
    std::optional<double> spacing;      ///< mean distance of neighbours, world units, instead of points
    SamplePattern pattern = SamplePattern::blue_noise;
    SampleNormals normals = SampleNormals::geometric;
    SampleSides sides = SampleSides::automatic;
    std::uint64_t seed = 1;

    static constexpr std::size_t default_points = 200'000;  ///< enough for a good picture of a room
};

struct SampleReport {
    double area = 0;                   ///< lit sides that were sampled, world units squared
    double spacing = 0;                ///< root of area over points, world units
    std::size_t degenerate_faces = 0;  ///< triangles without area, left out
    std::vector<std::string> warnings;
};

/// Points on the surface, each with normal, albedo (averaged over its share of the texture), emission, area, face and
/// material. Areas sum to the surface of each material and side. Lamps that would get too few points for their shape
/// get up to a thousand of them, at most a twentieth of all. The same bytes for the same seed at any number of threads.
///
/// - scene: indices in range, positions finite, as the importers deliver it
/// - throws UnsupportedInput for a scene without surface, UsageError for 0 points, for a spacing that is not positive
/// or
///   that asks for more points than fit in 32 bits, and for points together with spacing
[[nodiscard]] PointCloud sample_surface(const Scene& scene, const SampleConfig& config = {},
                                        const ProgressCallback& progress = {}, SampleReport* report = nullptr);

}  // namespace vmap
