// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// One scene by three renderers: ours, POV-Ray and the path tracer over the source triangles.
#pragma once

#include <crosscheck/povray.h>
#include <crosscheck/surface_view.h>
#include <vmap/compare/difference_figures.h>
#include <vmap/exporters/picture.h>
#include <vmap/point_cloud.h>
#include <vmap/scene.h>

#include <cstddef>
#include <filesystem>
#include <vector>

namespace vmap::crosscheck {

struct CrosscheckConfig {
    int width = 160;
    int height = 120;
    std::size_t points = 200'000;
    double tolerance = 0.01;   ///< of our light
    bool direct_only = false;  ///< no reflections, in all three
    int bounces = 10;          ///< of POV-Ray's radiosity, in which an emissive surface counts as one
    PovPreset preset = PovPreset::normal;
    std::size_t truth_pixels = 300;  ///< compared pixels at which the truth is traced
    bool whole_truth = false;        ///< traced at every pixel instead, for a picture
    std::size_t truth_samples = 1024;
    std::filesystem::path cache;  ///< folder that keeps POV-Ray's pictures and truths
};

struct Crosscheck {
    SurfaceView view;
    std::vector<std::size_t> pixels;  ///< that are compared: lit sides without emission, away from borders and, where
                                      ///< all light comes from points, spots and suns, from the edges of shadows
    Picture ours;
    double our_seconds = 0;  ///< of processor time, from the scene in memory to the picture in memory
    PovPicture povray;
    DifferenceFigures picture;    ///< our picture against POV-Ray's
    DifferenceFigures ply;        ///< E from the PLY file against E from POV-Ray's picture
    DifferenceFigures vdb;        ///< E from the OpenVDB grid, away from other surfaces, against the same
    Picture truth;                ///< where it was traced; black elsewhere
    DifferenceFigures our_error;  ///< our picture against the truth
    DifferenceFigures povray_error;
    double truth_noise = 0;  ///< mean standard error / mean
};

struct LitPicture {
    LitCloud cloud;
    Picture picture;
    double seconds = 0;            ///< from the scene in memory to the picture in memory
    double processor_seconds = 0;  ///< the same, summed over the threads
};

/// The first part of the cross-check: the scene as lit points and their picture.
/// - scene: with a camera
[[nodiscard]] LitPicture light_and_draw(const Scene& scene, const CrosscheckConfig& config);

/// - scene: with a camera
/// - throws std::runtime_error when POV-Ray fails
[[nodiscard]] Crosscheck cross_check(const Scene& scene, const CrosscheckConfig& config);

}  // namespace vmap::crosscheck
