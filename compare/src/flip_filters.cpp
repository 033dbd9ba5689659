// SPDX-License-Identifier: GPL-3.0-or-later
#include "flip_filters.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

namespace vmap {
namespace {

using std::numbers::pi;

/// Weights from -radius to radius.
using Kernel = std::vector<double>;

/// One term of a contrast sensitivity, a Gaussian in the frequency domain and in the plane: a, b of the paper's table.
struct Term {
    double amplitude;
    double width;  ///< degrees squared
};

constexpr double widest_term = 0.04;
constexpr double edge_width = 0.082;  ///< degrees: an edge that the eye detects best

std::span<const Term> sensitivity(EyeChannel channel) {
    static constexpr std::array<Term, 1> achromatic{{{1, 0.0047}}};
    static constexpr std::array<Term, 1> red_green{{{1, 0.0053}}};
    static constexpr std::array<Term, 2> blue_yellow{{{34.1, widest_term}, {13.5, 0.025}}};
    if (channel == EyeChannel::achromatic) return achromatic;
    if (channel == EyeChannel::red_green) return red_green;
    return blue_yellow;
}

template <class F>
Kernel kernel_of(int radius, const F& weight) {
    Kernel kernel;
    for (int i = -radius; i <= radius; ++i) kernel.push_back(weight(i));
    return kernel;
}

double sum_of(const Kernel& kernel) {
    return std::accumulate(kernel.begin(), kernel.end(), 0.0);
}

/// Value at x of a row (or column) that goes on as it ends.
double convolve_at(const float* first, std::ptrdiff_t stride, int count, int x, const Kernel& kernel) {
    const int radius = static_cast<int>(kernel.size() / 2);
    const auto middle = kernel.begin() + radius;
    double sum = 0;
    for (int i = -radius; i <= radius; ++i)
        sum += middle[i] * first[static_cast<std::ptrdiff_t>(std::clamp(x + i, 0, count - 1)) * stride];
    return sum;
}

Plane convolve(const Plane& plane, const Kernel& along_x, const Kernel& along_y) {
    Plane rows(plane.width, plane.height);
    Plane result(plane.width, plane.height);
    tbb::parallel_for(0, plane.height, [&](int y) {
        const std::ptrdiff_t begin = std::ptrdiff_t{y} * plane.width;
        for (int x = 0; x < plane.width; ++x)
            rows.values[static_cast<std::size_t>(begin + x)] =
                static_cast<float>(convolve_at(plane.values.data() + begin, 1, plane.width, x, along_x));
    });
    tbb::parallel_for(0, plane.height, [&](int y) {
        for (int x = 0; x < plane.width; ++x)
            result.values[static_cast<std::size_t>(std::ptrdiff_t{y} * plane.width + x)] =
                static_cast<float>(convolve_at(rows.values.data() + x, plane.width, plane.height, y, along_y));
    });
    return result;
}

/// Positive weights sum to 1, negative ones to -1.
void balance(Kernel& kernel) {
    double positive = 0;
    double negative = 0;
    for (const double weight : kernel) (weight > 0 ? positive : negative) += weight;
    for (double& weight : kernel) weight /= weight > 0 ? positive : -negative;
}

}  // namespace

Plane seen_by_eye(const Plane& plane, EyeChannel channel, double pixels_per_degree) {
    const int radius = static_cast<int>(std::ceil(3 * std::sqrt(widest_term / (2 * pi * pi)) * pixels_per_degree));
    Plane result(plane.width, plane.height);
    double total = 0;
    for (const Term& term : sensitivity(channel)) {
        const Kernel kernel = kernel_of(radius, [&](int i) {
            const double degrees = i / pixels_per_degree;
            return std::exp(-pi * pi * degrees * degrees / term.width);
        });
        const double share = term.amplitude * std::sqrt(pi / term.width);
        total += share * sum_of(kernel) * sum_of(kernel);
        const Plane part = convolve(plane, kernel, kernel);
        for (std::size_t i = 0; i < part.values.size(); ++i)
            result.values[i] += static_cast<float>(share * part.values[i]);
    }
    for (float& value : result.values) value = static_cast<float>(value / total);
    return result;
}

Plane feature_strength(const Plane& plane, Feature feature, double pixels_per_degree) {
    const double deviation = 0.5 * edge_width * pixels_per_degree;
    const int radius = static_cast<int>(std::ceil(3 * deviation));
    const auto gauss = [&](int i) { return std::exp(-i * i / (2 * deviation * deviation)); };
    Kernel across = kernel_of(radius, [&](int i) {
        return (feature == Feature::edge ? -i : i * i / (deviation * deviation) - 1) * gauss(i);
    });
    balance(across);
    Kernel along = kernel_of(radius, gauss);
    const double sum = sum_of(along);
    for (double& weight : along) weight /= sum;

    const Plane in_x = convolve(plane, across, along);
    const Plane in_y = convolve(plane, along, across);
    Plane strength(plane.width, plane.height);
    for (std::size_t i = 0; i < strength.values.size(); ++i)
        strength.values[i] = std::hypot(in_x.values[i], in_y.values[i]);
    return strength;
}

}  // namespace vmap
