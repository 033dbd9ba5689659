// SPDX-License-Identifier: GPL-3.0-or-later
#include "plane_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vmap {
namespace {

using Imath::V3d;

/// Some vector across a unit vector.
V3d across(const V3d& normal) {
    const V3d other = std::abs(normal.x) < 0.6 ? V3d(1, 0, 0) : V3d(0, 1, 0);
    return normal.cross(other).normalized();
}

}  // namespace

FittedPlane fit_plane(std::span<const V3d> points) {
    FittedPlane plane;
    const auto count = static_cast<double>(points.size());
    for (const V3d& point : points) plane.center += point;
    plane.center /= count;

    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    for (const V3d& point : points) {
        const V3d v = point - plane.center;
        const Eigen::Vector3d d(v.x, v.y, v.z);
        scatter += d * d.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
    const Eigen::Vector3d normal = solver.eigenvectors().col(0);
    plane.normal = V3d(normal.x(), normal.y(), normal.z()).normalized();
    const double freedom = std::max(count - 3, 1.0);
    plane.deviation = std::sqrt(std::max(solver.eigenvalues()[0], 0.0) / freedom);
    return plane;
}

FittedQuadric fit_quadric(std::span<const V3d> points, const FittedPlane& plane) {
    constexpr std::size_t unknowns = 6;
    if (points.size() < unknowns + 2) return {plane.normal, std::numeric_limits<double>::infinity()};
    const V3d u = across(plane.normal);
    const V3d v = plane.normal.cross(u);
    double scale = 0;
    for (const V3d& point : points) scale += (point - plane.center).length2();
    scale = std::sqrt(scale / static_cast<double>(points.size()));
    if (!(scale > 0)) return {plane.normal, 0};

    using Vector = Eigen::Matrix<double, unknowns, 1>;
    Eigen::Matrix<double, unknowns, unknowns> normal_matrix =
        Eigen::Matrix<double, unknowns, unknowns>::Identity() * 1e-9;
    Vector right_side = Vector::Zero();
    double squares = 0;
    for (const V3d& point : points) {
        const V3d d = (point - plane.center) / scale;
        const double x = d.dot(u);
        const double y = d.dot(v);
        const double height = d.dot(plane.normal);
        Vector row;
        row << 1, x, y, x * x, x * y, y * y;
        normal_matrix += row * row.transpose();
        right_side += row * height;
        squares += height * height;
    }
    const Vector solution = normal_matrix.ldlt().solve(right_side);
    const double left = std::max(squares - solution.dot(right_side), 0.0);
    const V3d at = (points.front() - plane.center) / scale;
    const double x = at.dot(u);
    const double y = at.dot(v);
    const double slope_u = solution[1] + 2 * solution[3] * x + solution[4] * y;
    const double slope_v = solution[2] + solution[4] * x + 2 * solution[5] * y;
    const V3d normal = (plane.normal - u * slope_u - v * slope_v).normalized();
    return {normal, scale * std::sqrt(left / static_cast<double>(points.size() - unknowns))};
}

}  // namespace vmap
