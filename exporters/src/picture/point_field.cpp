// SPDX-License-Identifier: GPL-3.0-or-later
#include "point_field.h"

#include <vmap/exporters/output_info.h>

#include <Imath/ImathBox.h>

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>

#include "frame.h"
#include "shapes.h"

namespace vmap::picture {
namespace {

using Imath::V3d;
using Imath::V3f;

/// Reach of a point in its own spacings: a dozen points count at each place, and a step in the light is spread over
/// less than two spacings.
constexpr float reach = 1.9F;

/// Reaches tried one after the other until enough points are found.
constexpr std::array<float, 5> widenings{1, 1.5F, 2.25F, 4, 8};

/// Points that a fit wants: it has three unknowns in a plane and five on a curved surface.
constexpr std::size_t enough_in_plane = 5;
constexpr std::size_t enough_on_curve = 7;

/// Within these a point counts as lying in the plane of a place.
constexpr float plane_cos = 1 - 2e-5F;    ///< of the angle between the normals: 0.4 degrees
constexpr float plane_height = 0.02F;     ///< in spacings
constexpr float least_normal_cos = 0.3F;  ///< points that face farther away never count
constexpr float rough_height = 0.8F;      ///< in spacings

/// Surface from this height over a plane on may cut off a part of it, in spacings.
constexpr float contact_height = 0.05F;
constexpr float contact_lift = 0.5F;

constexpr int cell_bits = 19;
constexpr std::int64_t cell_limit = std::int64_t{1} << cell_bits;

std::uint64_t hash(std::uint64_t key) {
    key ^= key >> 31;
    key *= 0x9E3779B97F4A7C15ULL;
    return key ^ (key >> 29);
}

/// Solves M a = (1, 0, 0, ...) for a symmetric positive definite matrix given by its lower half, by Cholesky's method.
template <std::size_t size>
std::array<double, size> solve_for_constant(std::array<std::array<double, size>, size>& m) {
    for (std::size_t column = 0; column < size; ++column) {
        for (std::size_t k = 0; k < column; ++k) m[column][column] -= m[column][k] * m[column][k];
        m[column][column] = std::sqrt(std::max(m[column][column], 1e-30));
        for (std::size_t row = column + 1; row < size; ++row) {
            for (std::size_t k = 0; k < column; ++k) m[row][column] -= m[row][k] * m[column][k];
            m[row][column] /= m[column][column];
        }
    }
    std::array<double, size> a{};
    for (std::size_t row = 0; row < size; ++row) {
        double sum = row == 0 ? 1 : 0;
        for (std::size_t k = 0; k < row; ++k) sum -= m[row][k] * a[k];
        a[row] = sum / m[row][row];
    }
    for (std::size_t row = size; row-- > 0;) {
        double sum = a[row];
        for (std::size_t k = row + 1; k < size; ++k) sum -= m[k][row] * a[k];
        a[row] = sum / m[row][row];
    }
    return a;
}

}  // namespace

PointField::PointField(const PointCloud& cloud, std::span<const std::uint32_t> sheets) {
    if (cloud.empty()) return;
    Imath::Box3f bounds;
    for (const V3f& p : cloud.positions) bounds.extendBy(p);
    low_ = bounds.min;
    const double extent = std::max({bounds.size().x, bounds.size().y, bounds.size().z, 1e-30F});

    const float mean = static_cast<float>(std::max(mean_spacing(cloud), 1e-6 * extent));
    std::vector<float> spacing(cloud.size(), mean);
    if (!cloud.areas.empty())
        for (std::size_t i = 0; i < cloud.size(); ++i)
            spacing[i] = std::clamp(std::sqrt(cloud.areas[i]), 1e-4F * mean, 1e4F * mean);
    std::vector<float> sorted = spacing;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
    spacing_ = sorted[sorted.size() / 2];

    // Level 0 holds spacings up to 1.25 of the median, each further one spacings up to twice the one before.
    const auto level_of = [&](float s) { return static_cast<int>(std::ceil(std::log2(s / (1.25F * spacing_)))); };
    std::vector<int> numbers(cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) numbers[i] = level_of(spacing[i]);
    std::vector<int> used = numbers;
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (const int number : used) {
        Level level;
        level.number = number - used.front();
        level.reach = reach * 1.25F * spacing_ * std::exp2(static_cast<float>(number));
        level.cell = std::max(static_cast<double>(level.reach), extent / (0.25 * static_cast<double>(cell_limit)));
        levels_.push_back(level);
    }

    std::vector<std::pair<std::uint64_t, std::uint32_t>> order(cloud.size());
    tbb::parallel_for(std::size_t{0}, cloud.size(), [&](std::size_t i) {
        const auto level = std::lower_bound(used.begin(), used.end(), numbers[i]) - used.begin();
        const Level& own = levels_[static_cast<std::size_t>(level)];
        order[i] = {key_of(own, cell_at(own, cloud.positions[i])), static_cast<std::uint32_t>(i)};
    });
    tbb::parallel_sort(order.begin(), order.end());

    points_.resize(cloud.size());
    index_.resize(cloud.size());
    tbb::parallel_for(std::size_t{0}, cloud.size(), [&](std::size_t i) {
        const std::uint32_t from = order[i].second;
        index_[i] = from;
        points_[i] = {cloud.positions[from], cloud.normals[from], spacing[from], sheets[from]};
    });

    std::size_t cells = 1;
    for (std::size_t i = 1; i < order.size(); ++i) cells += order[i].first != order[i - 1].first ? 1 : 0;
    std::size_t slots = 16;
    while (slots < 2 * cells) slots *= 2;
    slot_keys_.assign(slots, ~std::uint64_t{0});
    slots_.resize(slots);
    for (std::size_t i = 0; i < order.size();) {
        const std::size_t first = i;
        while (i < order.size() && order[i].first == order[first].first) ++i;
        std::size_t slot = hash(order[first].first) & (slots - 1);
        while (slot_keys_[slot] != ~std::uint64_t{0}) slot = (slot + 1) & (slots - 1);
        slot_keys_[slot] = order[first].first;
        slots_[slot] = {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(i - first)};
    }
}

PointField::Cell PointField::cell_at(const Level& level, const V3f& position) const {
    Cell cell{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double at = (static_cast<double>(position[static_cast<int>(axis)]) -
                           static_cast<double>(low_[static_cast<int>(axis)])) /
                          level.cell;
        const double limit = 0.25 * static_cast<double>(cell_limit);
        cell.at(axis) = static_cast<std::int64_t>(std::floor(std::clamp(at, -limit, 2 * limit)));
    }
    return cell;
}

std::uint64_t PointField::key_of(const Level& level, const Cell& cell) {
    auto key = static_cast<std::uint64_t>(level.number);
    for (std::size_t axis = 3; axis-- > 0;)
        key = (key << cell_bits) | (static_cast<std::uint64_t>(cell.at(axis) + cell_limit / 4) & (cell_limit - 1));
    return key;
}

const PointField::Range* PointField::find(std::uint64_t key) const {
    const std::size_t mask = slot_keys_.size() - 1;
    for (std::size_t slot = hash(key) & mask; slot_keys_[slot] != ~std::uint64_t{0}; slot = (slot + 1) & mask)
        if (slot_keys_[slot] == key) return &slots_[slot];
    return nullptr;
}

void PointField::collect_ranges(const Level& level, const Cell& center, int rings, std::vector<Range>& ranges) const {
    for (std::int64_t z = -rings; z <= rings; ++z)
        for (std::int64_t y = -rings; y <= rings; ++y)
            for (std::int64_t x = -rings; x <= rings; ++x)
                if (const Range* range = find(key_of(level, {center[0] + x, center[1] + y, center[2] + z})))
                    ranges.push_back(*range);
}

/// Where the points lie that may reach a place.
const std::vector<PointField::Range>& PointField::ranges_around(const Level& level, const V3f& position, float scale,
                                                                Workspace& workspace) const {
    const Cell center = cell_at(level, position);
    if (scale == 1) {
        const std::uint64_t key = key_of(level, center);
        Workspace::Remembered& remembered = workspace.remembered_[hash(key) % workspace.remembered_.size()];
        if (remembered.key != key) {
            remembered.key = key;
            remembered.ranges.clear();
            collect_ranges(level, center, 1, remembered.ranges);
        }
        return remembered.ranges;
    }
    workspace.ranges_.clear();
    const int rings = static_cast<int>(std::ceil(static_cast<double>(scale * level.reach) / level.cell));
    collect_ranges(level, center, rings, workspace.ranges_);
    return workspace.ranges_;
}

void PointField::neighbours(const V3f& position, float scale, Workspace& workspace,
                            std::vector<std::uint32_t>& found) const {
    found.clear();
    for (const Level& level : levels_)
        for (const Range& range : ranges_around(level, position, scale, workspace))
            for (std::uint32_t i = range.first; i < range.first + range.count; ++i)
                if ((points_[i].position - position).length() < scale * reach * points_[i].spacing)
                    found.push_back(index_[i]);
}

/// The points whose reach covers the place and that lie on its surface.
void PointField::gather(const SurfacePoint& place, float scale, Workspace& workspace) const {
    workspace.candidates_.clear();
    workspace.above_.clear();
    workspace.coplanar_count_ = 0;
    for (const Level& level : levels_)
        for (const Range& range : ranges_around(level, place.position, scale, workspace))
            for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
                const Point& point = points_[i];
                const V3f offset = point.position - place.position;
                const float limit = scale * reach * point.spacing;
                const float share = offset.length2() / (limit * limit);
                if (share >= 1) continue;
                if (place.normal.dot(offset) > contact_height * point.spacing) workspace.above_.push_back(index_[i]);
                if (point.sheet != place.sheet && place.sheet != any_sheet) continue;
                const float cos = place.normal.dot(point.normal);
                if (cos < least_normal_cos) continue;
                const float height = std::abs(place.normal.dot(offset));
                const bool coplanar = cos > plane_cos && height < plane_height * point.spacing;
                if (!coplanar) {
                    // On a smooth surface the height grows with half the turn of the normal over the distance.
                    const float turn = std::sqrt(std::max(0.0F, 2 - 2 * cos));
                    const float slack = (place.rough ? rough_height : 2 * plane_height) * point.spacing;
                    if (height > slack + turn * offset.length()) continue;
                }
                workspace.coplanar_count_ += coplanar ? 1 : 0;
                workspace.candidates_.push_back(
                    {offset, point.normal, (1 - share) * (1 - share), point.spacing, index_[i], coplanar});
            }
}

/// Leaves out points of the place's plane that other surfaces cut off from it: those that points above the plane are
/// on.
void PointField::leave_out_separated(const SurfacePoint& place, const Shapes& shapes, Workspace& workspace) const {
    std::vector<std::uint32_t>& polygons = workspace.above_;
    if (workspace.coplanar_count_ == 0 || polygons.empty() || shapes.point_polygons.empty()) return;
    for (std::uint32_t& entry : polygons) entry = shapes.point_polygons[entry];
    std::sort(polygons.begin(), polygons.end());
    polygons.erase(std::unique(polygons.begin(), polygons.end()), polygons.end());
    workspace.contacts_.start(place.position, place.normal, contact_lift * workspace.candidates_.front().spacing);
    for (const std::uint32_t polygon : polygons)
        if (!shapes.shapes[polygon].may_be_cut) workspace.contacts_.add(shapes.polygons[polygon]);
    if (workspace.contacts_.empty()) return;
    workspace.coplanar_count_ -= std::erase_if(workspace.candidates_, [&](const Workspace::Candidate& c) {
        return c.coplanar && workspace.contacts_.separates(c.offset);
    });
}

/// Moving least squares in the place's frame: the value at the place of the fit through the points' values is a
/// weighted sum of these, and the weights do not depend on the values.
void PointField::weigh(const SurfacePoint& place, Workspace& workspace, Mix& mix) const {
    std::vector<Workspace::Candidate>& candidates = workspace.candidates_;
    const bool in_plane = workspace.coplanar_count_ >= enough_in_plane;
    if (in_plane) std::erase_if(candidates, [](const Workspace::Candidate& c) { return !c.coplanar; });

    V3f normal = place.normal;
    if (place.rough) {
        V3f sum(0);
        for (const Workspace::Candidate& c : candidates) sum += c.normal * c.weight;
        if (sum.length() > 0) normal = sum.normalized();
    }
    const V3f u = any_perpendicular(normal);
    const V3f v = normal.cross(u);
    mix.nearest = std::min_element(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) {
                      return a.offset.length2() < b.offset.length2();
                  })->point;
    // A trace of ridge keeps the slope of points on a line at zero; that of the normals asks for a real range of them.
    constexpr double place_ridge = 1e-5;
    constexpr double normal_ridge = 2e-3;
    double total = 0;
    V3f drift(0);
    float spread = 0;
    for (const Workspace::Candidate& c : candidates) {
        total += static_cast<double>(c.weight);
        drift += c.offset * c.weight;
        spread += c.offset.length() * c.weight;
    }
    // Points all around a place drift by about a fifth of their distance, points in a half-plane by two thirds.
    mix.overhang = spread > 0 ? std::clamp(1.8F * drift.length() / spread - 0.2F, 0.0F, 1.0F) : 0.0F;

    const auto fit = [&]<std::size_t size>(const auto& terms_of) {
        std::array<std::array<double, size>, size> m{};
        for (const Workspace::Candidate& c : candidates) {
            const std::array<float, size> terms = terms_of(c);
            for (std::size_t row = 0; row < size; ++row)
                for (std::size_t column = 0; column <= row; ++column)
                    m[row][column] += static_cast<double>(c.weight * terms[row] * terms[column]);
        }
        for (std::size_t i = 1; i < size; ++i) m[i][i] += total * (i < 3 ? place_ridge : normal_ridge);
        const std::array<double, size> a = solve_for_constant(m);
        for (const Workspace::Candidate& c : candidates) {
            const std::array<float, size> terms = terms_of(c);
            double weight = 0;
            for (std::size_t i = 0; i < size; ++i) weight += static_cast<double>(terms[i]) * a[i];
            mix.points.push_back(c.point);
            mix.weights.push_back(static_cast<float>(weight) * c.weight);
        }
    };
    const float unit = 1 / candidates.front().spacing;
    if (in_plane)
        fit.template operator()<3>([&](const Workspace::Candidate& c) {
            return std::array<float, 3>{1, c.offset.dot(u) * unit, c.offset.dot(v) * unit};
        });
    else
        fit.template operator()<5>([&](const Workspace::Candidate& c) {
            return std::array<float, 5>{1, c.offset.dot(u) * unit, c.offset.dot(v) * unit, c.normal.dot(u),
                                        c.normal.dot(v)};
        });
}

void PointField::mix_at(const SurfacePoint& place, const Shapes& shapes, Workspace& workspace, Mix& mix) const {
    mix.clear();
    if (points_.empty()) return;
    SurfacePoint asked = place;
    for (const float scale : widenings) {
        gather(asked, scale, workspace);
        leave_out_separated(asked, shapes, workspace);
        const bool enough =
            workspace.coplanar_count_ >= enough_in_plane || workspace.candidates_.size() >= enough_on_curve;
        // A small sheet may hold only a few points: far ones add nothing.
        const bool last = scale >= 4 && !workspace.candidates_.empty();
        if (enough || last) return weigh(asked, workspace, mix);
    }
    if (place.sheet == any_sheet) return;
    asked.sheet = any_sheet;
    gather(asked, 2.25F, workspace);
    if (!workspace.candidates_.empty()) weigh(asked, workspace, mix);
}

}  // namespace vmap::picture
