// SPDX-License-Identifier: GPL-3.0-or-later
#include <crosscheck/lit_points.h>

#include <Eigen/Dense>
#include <nanoflann.hpp>

#include <array>
#include <cmath>
#include <numeric>
#include <vector>

namespace vmap::crosscheck {
namespace {

using Imath::V3d;

constexpr std::size_t neighbours = 32;
constexpr int fewest = 6;

}  // namespace

class LitPoints::Tree {
public:
    explicit Tree(const std::vector<V3d>& positions) : positions_(positions), index_(3, *this) {}

    [[nodiscard]] std::size_t kdtree_get_point_count() const { return positions_.size(); }
    [[nodiscard]] double kdtree_get_pt(std::size_t index, std::size_t axis) const {
        return positions_[index][static_cast<int>(axis)];
    }
    template <class Box>
    bool kdtree_get_bbox(Box& /*box*/) const {
        return false;
    }

    [[nodiscard]] std::vector<std::size_t> nearest(const V3d& position) const {
        std::vector<std::size_t> found(neighbours);
        std::array<double, neighbours> squares{};
        found.resize(index_.knnSearch(&position.x, neighbours, found.data(), squares.data()));
        return found;
    }
    [[nodiscard]] std::vector<std::size_t> within(const V3d& position, double radius) const {
        std::vector<std::pair<std::size_t, double>> found;
        index_.radiusSearch(&position.x, radius * radius, found, nanoflann::SearchParams());
        std::vector<std::size_t> indices;
        indices.reserve(found.size());
        for (const auto& [index, square] : found) indices.push_back(index);
        return indices;
    }

private:
    const std::vector<V3d>& positions_;
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Tree>, Tree, 3, std::size_t> index_;
};

LitPoints::LitPoints(const reference::LitPly& points)
    : points_(points), tree_(std::make_unique<Tree>(points.positions)) {
    const double area = std::accumulate(points.areas.begin(), points.areas.end(), 0.0);
    spacing_ = std::sqrt(area / static_cast<double>(points.size()));
}

LitPoints::~LitPoints() = default;

bool LitPoints::is_alike(std::size_t point, const V3d& position, const V3d& normal) const {
    const V3d way = points_.positions[point] - position;
    return points_.normals[point].dot(normal) > 0.95 &&
           std::abs(way.dot(normal)) < 0.05 * spacing_ + 0.3 * way.length();
}

std::optional<Imath::C3f> LitPoints::irradiance_at(const V3d& position, const V3d& normal) const {
    const V3d side = std::abs(normal.x) > 0.5 ? V3d(0, 1, 0) : V3d(1, 0, 0);
    const V3d u = normal.cross(side).normalized();
    const V3d v = normal.cross(u);
    Eigen::Matrix3d left = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d right = Eigen::Matrix3d::Zero();
    int count = 0;
    for (const std::size_t i : tree_->nearest(position)) {
        if (!is_alike(i, position, normal)) continue;
        const V3d way = (points_.positions[i] - position) / spacing_;
        const Eigen::Vector3d row(1, way.dot(u), way.dot(v));
        const double weight = std::exp(-way.length2() / 2);
        const Imath::C3f& value = points_.irradiance[i];
        left += weight * row * row.transpose();
        right += weight * row * Eigen::RowVector3d(value.x, value.y, value.z);
        ++count;
    }
    if (count < fewest) return std::nullopt;
    const Eigen::Matrix3d fit = left.ldlt().solve(right);
    return Imath::C3f(static_cast<float>(fit(0, 0)), static_cast<float>(fit(0, 1)), static_cast<float>(fit(0, 2)));
}

bool LitPoints::is_alone(const V3d& position, const V3d& normal, double radius) const {
    for (const std::size_t i : tree_->within(position, radius))
        if (!is_alike(i, position, normal)) return false;
    return true;
}

}  // namespace vmap::crosscheck
