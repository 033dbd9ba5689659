// SPDX-License-Identifier: GPL-3.0-or-later
#include <vmap/compare/compare_clouds.h>
#include <vmap/error.h>
#include <vmap/exporters/output_info.h>

#include <tbb/parallel_for.h>
#include <nanoflann.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace vmap {
namespace {

using Imath::V3d;
using Imath::V3f;

constexpr std::size_t neighbours = 16;
constexpr float same_side = 0.5F;  ///< cosine

/// What nanoflann asks of a set of points: the result's, about the reference's origin.
class PointSet {
public:
    PointSet(const PointCloud& cloud, const V3d& origin) {
        const V3d shift = cloud.origin - origin;
        positions_.reserve(cloud.size());
        for (const V3f& position : cloud.positions) positions_.emplace_back(V3d(position) + shift);
    }
    [[nodiscard]] std::size_t kdtree_get_point_count() const { return positions_.size(); }
    [[nodiscard]] double kdtree_get_pt(std::size_t index, std::size_t axis) const {
        return positions_[index][static_cast<int>(axis)];
    }
    template <class Box>
    bool kdtree_get_bbox(Box& /*box*/) const {
        return false;
    }

private:
    std::vector<V3d> positions_;
};

using KdTree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, PointSet>, PointSet, 3, std::size_t>;

double mean_of(const Imath::C3f& color) {
    return (static_cast<double>(color.x) + color.y + color.z) / 3;
}

void check(const LitCloud& cloud, const char* which) {
    if (cloud.points.empty()) throw UsageError(std::string(which) + " has no points");
    if (cloud.irradiance.size() != cloud.points.size())
        throw UsageError(std::string(which) + " has no irradiance, expected a lit cloud");
}

struct Partner {
    std::size_t index = 0;
    double distance = 0;
};

Partner partner_of(const KdTree& tree, const PointCloud& result, const PointCloud& reference, std::size_t point) {
    std::array<std::size_t, neighbours> found{};
    std::array<double, neighbours> squares{};
    const V3d position(reference.positions[point]);
    const std::size_t count = tree.knnSearch(&position.x, neighbours, found.data(), squares.data());
    std::size_t best = 0;
    if (!result.normals.empty() && !reference.normals.empty()) {
        const auto faces_alike = [&](std::size_t index) {
            return result.normals[index].dot(reference.normals[point]) > same_side;
        };
        const auto* alike = std::find_if(found.begin(), found.begin() + count, faces_alike);
        if (alike != found.begin() + count) best = static_cast<std::size_t>(alike - found.begin());
    }
    return {found[best], std::sqrt(squares[best])};
}

}  // namespace

CloudComparison compare_clouds(const LitCloud& result, const LitCloud& reference) {
    check(result, "the first cloud");
    check(reference, "the second cloud");
    const PointSet points(result.points, reference.points.origin);
    const KdTree tree(3, points);

    const std::size_t count = reference.points.size();
    std::vector<double> results(count);
    std::vector<double> references(count);
    std::vector<double> differences(count);
    std::vector<double> distances(count);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        const Partner partner = partner_of(tree, result.points, reference.points, i);
        results[i] = mean_of(result.irradiance[partner.index]);
        references[i] = mean_of(reference.irradiance[i]);
        differences[i] = std::abs(results[i] - references[i]);
        distances[i] = partner.distance;
    });
    const std::vector<double> weights(reference.points.areas.begin(), reference.points.areas.end());
    CloudComparison comparison;
    comparison.figures = difference_figures(differences, results, references, weights);
    comparison.histogram = difference_histogram(differences, comparison.figures.mean_reference, weights);
    for (const double distance : distances) comparison.mean_distance += distance / static_cast<double>(count);
    comparison.spacing = mean_spacing(reference.points);
    return comparison;
}

}  // namespace vmap
