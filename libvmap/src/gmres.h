// SPDX-License-Identifier: Apache-2.0
/// \file
/// Solves x = b + K x for a linear K that is known by its action only.
///
/// This work is based on: Y. Saad, M. H. Schultz, "GMRES", SIAM J. Sci. Stat. Comput. 1986.
#pragma once

#include <functional>
#include <vector>

namespace vmap {

struct FixedPointResult {
    std::vector<float> x;
    double residual = 0;  ///< |b + K x - x| / |b|
    int steps = 0;
};

/// - apply: K times a vector of b's size
/// - tolerance: residual at which to stop; at most max_steps applications of K
[[nodiscard]] FixedPointResult solve_fixed_point(
    const std::vector<float>& b, const std::function<std::vector<float>(const std::vector<float>&)>& apply,
    double tolerance, int max_steps = 40);

}  // namespace vmap
