// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How much a picture differs from another one that it should be like.
#pragma once

#include <vmap/compare/difference_figures.h>
#include <vmap/compare/flip.h>
#include <vmap/exporters/picture.h>

#include <vector>

namespace vmap {

struct PictureComparison {
    DifferenceFigures figures;  ///< the difference of a pixel is the mean of its channels' absolute differences
    DifferenceHistogram histogram;
    double flip = 0;                 ///< mean over the pixels
    std::vector<double> difference;  ///< of each pixel, in the pictures' unit, rows from the top
    std::vector<float> flip_map;     ///< of each pixel
};

/// - range: what the pictures hold
/// - throws UsageError for pictures of different sizes, or without pixels
[[nodiscard]] PictureComparison compare_pictures(const Picture& result, const Picture& reference, FlipRange range);

}  // namespace vmap
