// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Whole numbers of points for parts of a surface, in proportion to their areas, with an exact sum.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace vmap {

/// Nearest whole numbers by largest remainder, at least 1 each where there are enough; earlier parts win ties.
/// - areas: positive
[[nodiscard]] std::vector<std::size_t> share_out_nearest(std::span<const double> areas, std::size_t total);

/// Whole numbers next to the exact ones, so that any run of parts together has next to its exact number too.
/// - areas: not negative, with a positive sum
/// - offset: in [0, 1), where the first point falls; over all offsets each part has its exact number on average
[[nodiscard]] std::vector<std::size_t> share_out_in_order(std::span<const double> areas, std::size_t total,
                                                          double offset);

}  // namespace vmap
