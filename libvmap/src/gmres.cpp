// SPDX-License-Identifier: Apache-2.0
#include "gmres.h"

#include <cmath>
#include <cstddef>

namespace vmap {
namespace {

using Vector = std::vector<float>;

/// In double and in order: the same bits at any number of threads.
double dot(const Vector& a, const Vector& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += static_cast<double>(a[i]) * static_cast<double>(b[i]);
    return sum;
}

void add_scaled(Vector& a, double factor, const Vector& b) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] += static_cast<float>(factor) * b[i];
}

}  // namespace

FixedPointResult solve_fixed_point(const Vector& b, const std::function<Vector(const Vector&)>& apply, double tolerance,
                                   int max_steps) {
    FixedPointResult result{Vector(b.size(), 0.0F), 0, 0};
    const double size = std::sqrt(dot(b, b));
    if (!(size > 0)) return result;

    std::vector<Vector> basis{b};
    for (float& value : basis[0]) value = static_cast<float>(static_cast<double>(value) / size);
    std::vector<std::vector<double>> columns;  // of the upper triangular matrix
    std::vector<double> cosines;
    std::vector<double> sines;
    std::vector<double> right{size};
    while (result.steps < max_steps && std::abs(right.back()) > tolerance * size) {
        const Vector& last = basis.back();
        Vector next = apply(last);
        for (std::size_t i = 0; i < next.size(); ++i) next[i] = last[i] - next[i];
        std::vector<double> column;
        for (const Vector& direction : basis) {
            column.push_back(dot(direction, next));
            add_scaled(next, -column.back(), direction);
        }
        double length = std::sqrt(dot(next, next));
        for (std::size_t i = 0; i < cosines.size(); ++i) {
            const double upper = cosines[i] * column[i] + sines[i] * column[i + 1];
            column[i + 1] = cosines[i] * column[i + 1] - sines[i] * column[i];
            column[i] = upper;
        }
        const double hypotenuse = std::hypot(column.back(), length);
        ++result.steps;
        if (!(hypotenuse > 0)) break;
        cosines.push_back(column.back() / hypotenuse);
        sines.push_back(length / hypotenuse);
        column.back() = hypotenuse;
        columns.push_back(std::move(column));
        const double top = right.back();
        right.back() = cosines.back() * top;
        right.push_back(-sines.back() * top);
        if (length <= 1e-12) break;
        for (float& value : next) value = static_cast<float>(static_cast<double>(value) / length);
        basis.push_back(std::move(next));
    }
    result.residual = std::abs(right.back()) / size;
    std::vector<double> y(columns.size());
    for (std::size_t i = columns.size(); i-- > 0;) {
        double value = right[i];
        for (std::size_t k = i + 1; k < columns.size(); ++k) value -= columns[k][i] * y[k];
        y[i] = value / columns[i][i];
        add_scaled(result.x, y[i], basis[i]);
    }
    return result;
}

}  // namespace vmap
