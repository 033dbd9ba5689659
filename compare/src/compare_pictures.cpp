// SPDX-License-Identifier: GPL-3.0-or-later
#include <vmap/compare/compare_pictures.h>
#include <vmap/error.h>

#include <cmath>
#include <cstddef>
#include <numeric>

namespace vmap {
namespace {

double mean_of(const Imath::C3f& color) {
    return (static_cast<double>(color.x) + color.y + color.z) / 3;
}

double difference_of(const Imath::C3f& a, const Imath::C3f& b) {
    double sum = 0;
    for (int c = 0; c < 3; ++c) sum += std::abs(static_cast<double>(a[c]) - b[c]);
    return sum / 3;
}

}  // namespace

PictureComparison compare_pictures(const Picture& result, const Picture& reference, FlipRange range) {
    if (reference.pixels.empty()) throw UsageError("pictures without pixels cannot be compared");
    PictureComparison comparison;
    comparison.flip_map = flip_map(result, reference, range);  // refuses different sizes
    std::vector<double> results;
    std::vector<double> references;
    for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
        results.push_back(mean_of(result.pixels[i]));
        references.push_back(mean_of(reference.pixels[i]));
        comparison.difference.push_back(difference_of(result.pixels[i], reference.pixels[i]));
    }
    comparison.figures = difference_figures(comparison.difference, results, references);
    comparison.histogram = difference_histogram(comparison.difference, comparison.figures.mean_reference);
    comparison.flip = std::accumulate(comparison.flip_map.begin(), comparison.flip_map.end(), 0.0) /
                      static_cast<double>(comparison.flip_map.size());
    return comparison;
}

}  // namespace vmap
