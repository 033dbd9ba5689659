// SPDX-License-Identifier: Apache-2.0
#include "local_fit.h"

#include <tbb/parallel_for.h>

#include <cmath>

namespace vmap {
namespace {

using Imath::C3f;
using Imath::V2f;
using Imath::V3f;

constexpr int least_window = 2;             ///< neighbours on each side,
constexpr int most_window = 4;              ///< more of them where there are few, as in the corner of a grid
constexpr std::size_t quadratic_from = 13;  ///< neighbours that make a quadratic worth fitting
constexpr std::size_t linear_from = 6;      ///< and a plane

using Basis = std::array<double, 6>;

Basis basis_at(double x, double y) {
    return {1, x, y, x * x, x * y, y * y};
}

/// Inverse of a symmetric positive matrix of size n by Cholesky; false when it is singular.
bool invert(std::array<Basis, 6>& m, std::size_t n) {
    std::array<Basis, 6> l{};
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j <= i; ++j) {
            double sum = m.at(i).at(j);
            for (std::size_t k = 0; k < j; ++k) sum -= l.at(i).at(k) * l.at(j).at(k);
            if (i == j) {
                if (!(sum > 1e-9 * m.at(i).at(i))) return false;
                l.at(i).at(i) = std::sqrt(sum);
            } else {
                l.at(i).at(j) = sum / l.at(j).at(j);
            }
        }
    for (std::size_t column = 0; column < n; ++column) {
        Basis y{};
        for (std::size_t i = 0; i < n; ++i) {
            double sum = i == column ? 1 : 0;
            for (std::size_t k = 0; k < i; ++k) sum -= l.at(i).at(k) * y.at(k);
            y.at(i) = sum / l.at(i).at(i);
        }
        for (std::size_t i = n; i-- > 0;) {
            double sum = y.at(i);
            for (std::size_t k = i + 1; k < n; ++k) sum -= l.at(k).at(i) * m.at(k).at(column);
            m.at(i).at(column) = sum / l.at(i).at(i);
        }
    }
    return true;
}

/// How far above the surface it is looked along it.
V3f lift_over(const Surface& surface, const Patch& patch) {
    return patch.normal * (8 * surface.gather_offset(patch));
}

}  // namespace

/// The receivers that a fit looks at.
struct LocalFit::Neighborhood {
    std::vector<std::uint32_t> receivers;
    std::vector<V2f> offsets;    ///< from the fitted receiver, in the patch's plane
    std::vector<double> kernel;  ///< how much each of them counts
    bool contact = false;
};

/// What one task makes, before it is put in order.
struct LocalFit::GridStencils {
    std::vector<std::uint32_t> receivers;
    std::vector<std::uint32_t> counts;
    std::vector<std::uint32_t> neighbors;
    std::vector<std::array<float, 6>> weights;
};

LocalFit::LocalFit(const Surface& surface, std::span<const ReceiverGrid> grids, std::span<const Receiver> receivers)
    : surface_(&surface), receivers_(receivers), stencils_(receivers.size()) {
    std::vector<GridStencils> made(grids.size());
    tbb::parallel_for(std::size_t{0}, grids.size(), [&](std::size_t g) {
        grids[g].for_each_vertex([&](const ReceiverGrid::Vertex& vertex, const Imath::V2i& at) {
            add_stencil(grids[g], vertex, at, made[g]);
        });
    });
    for (const GridStencils& part : made) {
        auto first = static_cast<std::uint32_t>(neighbors_.size());
        for (std::size_t i = 0; i < part.receivers.size(); ++i) {
            stencils_[part.receivers[i]] = {first, part.counts[i]};
            first += part.counts[i];
        }
        neighbors_.insert(neighbors_.end(), part.neighbors.begin(), part.neighbors.end());
        weights_.insert(weights_.end(), part.weights.begin(), part.weights.end());
    }
}

LocalFit::Neighborhood LocalFit::neighborhood(const ReceiverGrid& grid, const ReceiverGrid::Vertex& vertex,
                                              const Imath::V2i& at, int window) const {
    const Receiver& own = receivers_[vertex.receiver];
    const V3f lift = lift_over(*surface_, surface_->set.patches[own.patch]);
    const int size = ReceiverGrid::steps_of(vertex.level);
    Neighborhood found;
    for (int dy = -window; dy <= window; ++dy)
        for (int dx = -window; dx <= window; ++dx) {
            const ReceiverGrid::Vertex* other = grid.vertex_at({at.x + dx * size, at.y + dy * size});
            if (other == nullptr) continue;
            const Receiver& neighbor = receivers_[other->receiver];
            if (neighbor.buried) continue;
            const double reach = window + 0.9;
            const double near = 1 - (dx * dx + dy * dy) / (1.3 * reach * reach);
            found.contact = found.contact || other->contact;
            found.receivers.push_back(other->receiver);
            found.offsets.emplace_back(neighbor.place - own.place);
            found.kernel.push_back(std::max(near, 0.05) * std::max(near, 0.05));
        }
    if (!found.contact) return found;
    const auto hidden = [&](std::uint32_t receiver) {
        return receiver != vertex.receiver &&
               surface_->bvh.any_hit({own.position + lift, receivers_[receiver].position - own.position, 0, 1});
    };
    std::size_t kept = 0;
    for (std::size_t i = 0; i < found.receivers.size(); ++i) {
        if (hidden(found.receivers[i])) continue;
        found.receivers[kept] = found.receivers[i];
        found.offsets[kept] = found.offsets[i];
        found.kernel[kept++] = found.kernel[i];
    }
    found.receivers.resize(kept);
    return found;
}

void LocalFit::add_stencil(const ReceiverGrid& grid, const ReceiverGrid::Vertex& vertex, const Imath::V2i& at,
                           GridStencils& made) const {
    Neighborhood near = neighborhood(grid, vertex, at, least_window);
    for (int window = least_window + 1; window <= most_window && near.receivers.size() < quadratic_from; ++window)
        near = neighborhood(grid, vertex, at, window);
    const std::size_t count = near.receivers.size();
    const double scale =
        1.0 / (ReceiverGrid::steps_of(vertex.level) * static_cast<double>(std::max(grid.step().x, grid.step().y)));
    std::vector<Basis> basis(count);
    for (std::size_t i = 0; i < count; ++i)
        basis[i] =
            basis_at(static_cast<double>(near.offsets[i].x) * scale, static_cast<double>(near.offsets[i].y) * scale);

    std::array<Basis, 6> inverse{};
    std::size_t terms = count >= quadratic_from ? 6 : (count >= linear_from ? 3 : 1);
    for (; terms > 1; terms = terms == 6 ? 3 : 1) {
        inverse = {};
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t r = 0; r < terms; ++r)
                for (std::size_t c = 0; c < terms; ++c)
                    inverse.at(r).at(c) += near.kernel[i] * basis[i].at(r) * basis[i].at(c);
        if (invert(inverse, terms)) break;
    }

    const Receiver& own = receivers_[vertex.receiver];
    made.receivers.push_back(vertex.receiver);
    if (terms == 1 && own.buried && count > 0) {
        // Too few neighbours for a slope: their mean.
        made.counts.push_back(static_cast<std::uint32_t>(count));
        for (const std::uint32_t neighbor : near.receivers) {
            made.neighbors.push_back(neighbor);
            made.weights.push_back({1 / static_cast<float>(count), 0, 0, 0, 0, 0});
        }
        return;
    }
    if (terms == 1) {
        made.counts.push_back(1);
        made.neighbors.push_back(vertex.receiver);
        made.weights.push_back({1, 0, 0, 0, 0, 0});
        return;
    }
    made.counts.push_back(static_cast<std::uint32_t>(count));
    const std::array<double, 6> units{1, scale, scale, scale * scale, scale * scale, scale * scale};
    for (std::size_t i = 0; i < count; ++i) {
        std::array<float, 6> weight{};
        for (std::size_t r = 0; r < terms; ++r) {
            double sum = 0;
            for (std::size_t c = 0; c < terms; ++c) sum += inverse.at(r).at(c) * basis[i].at(c);
            weight.at(r) = static_cast<float>(sum * near.kernel[i] * units.at(r));
        }
        made.neighbors.push_back(near.receivers[i]);
        made.weights.push_back(weight);
    }
}

std::vector<Quadratic> LocalFit::fit(std::span<const float> values) const {
    std::vector<Quadratic> field(stencils_.size());
    tbb::parallel_for(std::size_t{0}, stencils_.size(), [&](std::size_t r) {
        Quadratic& q = field[r];
        const Stencil& stencil = stencils_[r];
        const auto value = [&](std::size_t i) { return C3f(values[3 * i], values[3 * i + 1], values[3 * i + 2]); };
        if (stencil.count == 0) {
            q.fill(C3f(0, 0, 0));
            q[0] = value(r);
            return;
        }
        q.fill(C3f(0, 0, 0));
        for (std::uint32_t i = stencil.first; i < stencil.first + stencil.count; ++i) {
            const C3f v = value(neighbors_[i]);
            for (std::size_t k = 0; k < 6; ++k) q.at(k) += v * weights_[i].at(k);
        }
    });
    return field;
}

C3f LocalFit::value_at(const FieldPlace& place, std::span<const Quadratic> field) const {
    C3f sum(0, 0, 0);
    for (std::size_t k = 0; k < 4; ++k) {
        const float w = place.weight.at(k);
        if (!(w > 0)) continue;
        const std::uint32_t r = place.receiver.at(k);
        const V2f d = place.place - receivers_[r].place;
        const Quadratic& q = field[r];
        sum += (q[0] + q[1] * d.x + q[2] * d.y + q[3] * (d.x * d.x) + q[4] * (d.x * d.y) + q[5] * (d.y * d.y)) * w;
    }
    return sum;
}

FieldPlace LocalFit::locate(const ReceiverGrid& grid, const V2f& place, bool careful) const {
    const auto [cell, weights] = grid.locate(place);
    FieldPlace result{cell->vertex, weights, place};
    if (!careful || !cell->contact) return result;
    const Patch& patch = surface_->set.patches[grid.patch()];
    const V3f lift = lift_over(*surface_, patch);
    const V3f from = patch.from_plane(place) + lift;
    std::array<Ray, 4> rays;
    std::array<std::uint8_t, 4> blocked{};
    for (std::size_t k = 0; k < 4; ++k)
        rays.at(k) = {from, receivers_[result.receiver.at(k)].position + lift - from, 0, 1};
    surface_->bvh.any_hits(rays, blocked);
    float seen = 0;
    for (std::size_t k = 0; k < 4; ++k)
        if (blocked.at(k) == 0) seen += result.weight.at(k);
    if (!(seen > 1e-4F)) return result;
    for (std::size_t k = 0; k < 4; ++k) result.weight.at(k) = blocked.at(k) == 0 ? result.weight.at(k) / seen : 0.0F;
    return result;
}

}  // namespace vmap
