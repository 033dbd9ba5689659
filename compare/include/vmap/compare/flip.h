// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// FLIP: how strongly a person who flickers between two pictures sees a difference at each pixel.
///
/// This work is based on:
///   P. Andersson, J. Nilsson, T. Akenine-Möller, M. Oskarsson, K. Åström, M. D. Fairchild, "FLIP: A difference
///   evaluator for alternating images", HPG 2020;
///   P. Andersson, J. Nilsson, P. Shirley, T. Akenine-Möller, "Visualizing errors in rendered high dynamic range
///   images", Eurographics 2021.
#pragma once

#include <vmap/exporters/picture.h>

#include <vector>

namespace vmap {

enum class FlipRange {
    display,  ///< pictures as a display shows them: values from 0 to 1, anything beyond is clamped
    high      ///< radiances of any size: the largest FLIP over the exposures that a viewer may choose
};

/// Pixels per degree of a 0.7 m wide display of 3840 pixels seen from 0.7 m, as the authors propose.
inline constexpr double usual_pixels_per_degree = 67.0206;

/// FLIP of each pixel, in [0, 1], rows from the top.
/// - test, reference: of the same size; throws UsageError otherwise
[[nodiscard]] std::vector<float> flip_map(const Picture& test, const Picture& reference, FlipRange range,
                                          double pixels_per_degree = usual_pixels_per_degree);

}  // namespace vmap
