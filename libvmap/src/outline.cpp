// SPDX-License-Identifier: Apache-2.0
#include <vmap/outline.h>
#include <vmap/polygon_set.h>

#include <Imath/ImathBox.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vmap {
namespace {

using Imath::V2d;
using Polygon = std::vector<V2d>;

double cross(const V2d& a, const V2d& b) {
    return a.x * b.y - a.y * b.x;
}

double perimeter(std::span<const V2d> polygon) {
    double sum = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) sum += (polygon[(i + 1) % polygon.size()] - polygon[i]).length();
    return sum;
}

/// The rectangle of least area around a convex polygon: one of its sides lies on an edge of the polygon.
Polygon least_rectangle(const Polygon& hull) {
    Polygon best;
    double best_area = std::numeric_limits<double>::max();
    for (std::size_t i = 0; i < hull.size(); ++i) {
        const V2d u = (hull[(i + 1) % hull.size()] - hull[i]).normalized();
        const V2d v(-u.y, u.x);
        Imath::Box2d box;
        for (const V2d& p : hull) box.extendBy(V2d(p.dot(u), p.dot(v)));
        const V2d size = box.size();
        if (size.x * size.y >= best_area) continue;
        best_area = size.x * size.y;
        best = {u * box.min.x + v * box.min.y, u * box.max.x + v * box.min.y, u * box.max.x + v * box.max.y,
                u * box.min.x + v * box.max.y};
    }
    return best;
}

/// Where the edges before and after edge i meet when it is left out; no value when they never do.
std::optional<V2d> meeting_without(const Polygon& polygon, std::size_t i) {
    const std::size_t n = polygon.size();
    const V2d& a = polygon[(i + n - 1) % n];
    const V2d& b = polygon[i];
    const V2d& c = polygon[(i + 1) % n];
    const V2d& d = polygon[(i + 2) % n];
    const double turn = cross(b - a, d - c);
    if (turn <= 1e-9 * (b - a).length() * (d - c).length()) return {};
    return b + (b - a) * (cross(c - b, d - c) / turn);
}

/// Leaves out the edges whose removal adds least area until `count` are left or none can go.
Polygon with_fewer_edges(Polygon polygon, std::size_t count) {
    while (polygon.size() > count) {
        std::size_t best = polygon.size();
        double least = std::numeric_limits<double>::max();
        V2d best_vertex(0, 0);
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const std::optional<V2d> vertex = meeting_without(polygon, i);
            if (!vertex) continue;
            const double added = cross(polygon[(i + 1) % polygon.size()] - polygon[i], *vertex - polygon[i]) / -2;
            if (added < least) {
                least = added;
                best = i;
                best_vertex = *vertex;
            }
        }
        if (best == polygon.size()) break;
        polygon[best] = best_vertex;
        polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>((best + 1) % polygon.size()));
    }
    return polygon;
}

/// The offset at which a convex polygon encloses `area`: area + perimeter d + corner d^2 grows like that for mitred
/// corners as long as no edge vanishes.
double offset_for_area(const Polygon& polygon, double area) {
    double corner = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const V2d in = (polygon[(i + 1) % polygon.size()] - polygon[i]).normalized();
        const V2d out = (polygon[(i + 2) % polygon.size()] - polygon[(i + 1) % polygon.size()]).normalized();
        corner += std::tan(std::atan2(cross(in, out), in.dot(out)) / 2);
    }
    const double missing = area - polygon_area(polygon);
    const double length = perimeter(polygon);
    const double root = length * length + 4 * corner * missing;
    return root <= 0 ? -length / (2 * corner) : 2 * missing / (length + std::sqrt(root));
}

/// Directions in which only the outermost points are kept before the hull is sorted: linear, and it loses no vertex
/// that matters at the resolution of the points.
constexpr std::size_t profile_rows = 512;

/// Points that can be vertices of the hull: the two ends of every row of a fine grid.
Polygon hull_candidates(std::span<const V2d> points) {
    if (points.size() <= 2 * profile_rows) return {points.begin(), points.end()};
    double low = points[0].y;
    double high = points[0].y;
    for (const V2d& p : points) {
        low = std::min(low, p.y);
        high = std::max(high, p.y);
    }
    const double scale = high > low ? static_cast<double>(profile_rows - 1) / (high - low) : 0;
    std::vector<const V2d*> left(profile_rows, nullptr);
    std::vector<const V2d*> right(profile_rows, nullptr);
    Polygon candidates;
    for (const V2d& p : points) {
        const auto row = static_cast<std::size_t>((p.y - low) * scale);
        if (!left[row] || p.x < left[row]->x) left[row] = &p;
        if (!right[row] || p.x > right[row]->x) right[row] = &p;
        if (p.y == low || p.y == high) candidates.push_back(p);
    }
    for (std::size_t row = 0; row < profile_rows; ++row) {
        if (!left[row]) continue;
        candidates.push_back(*left[row]);
        candidates.push_back(*right[row]);
    }
    return candidates;
}

}  // namespace

double polygon_area(std::span<const V2d> polygon) {
    double sum = 0;
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
        sum += cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]);
    return sum / 2;
}

std::vector<V2d> convex_hull(std::vector<V2d> points) {
    std::sort(points.begin(), points.end(),
              [](const V2d& a, const V2d& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    points.erase(std::unique(points.begin(), points.end()), points.end());
    if (points.size() < 3) return points;
    Polygon hull(2 * points.size());
    std::size_t k = 0;
    const auto extend = [&](const V2d& p, std::size_t keep) {
        while (k >= keep && cross(hull[k - 1] - hull[k - 2], p - hull[k - 2]) <= 0) --k;
        hull[k++] = p;
    };
    for (const V2d& p : points) extend(p, 2);
    const std::size_t lower = k + 1;
    for (std::size_t i = points.size() - 1; i-- > 0;) extend(points[i], lower);
    hull.resize(k - 1);
    return hull;
}

std::vector<V2d> offset_polygon(std::span<const V2d> polygon, double distance) {
    Polygon moved(polygon.size());
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const V2d in = (polygon[i] - polygon[(i + polygon.size() - 1) % polygon.size()]).normalized();
        const V2d out = (polygon[(i + 1) % polygon.size()] - polygon[i]).normalized();
        // The vertex slides along the bisector; at most eight offsets far where two edges all but fold back.
        const double half_cos2 = std::max((1 + in.dot(out)) / 2, 1.0 / 64);
        const V2d outwards = V2d(in.y + out.y, -in.x - out.x) / 2;
        moved[i] = polygon[i] + outwards * (distance / half_cos2);
    }
    return moved;
}

std::optional<std::vector<V2d>> fit_outline(std::span<const V2d> points, double area, double spacing) {
    const Polygon hull = convex_hull(hull_candidates(points));
    if (hull.size() < 3 || polygon_area(hull) <= 0.25 * spacing * spacing) return {};
    const auto plausible = [&](double offset) { return offset >= -0.15 * spacing && offset <= 0.95 * spacing; };

    const Polygon rectangle = least_rectangle(hull);
    const double side_offset = offset_for_area(rectangle, area);
    if (plausible(side_offset)) return offset_polygon(rectangle, side_offset);
    if (!plausible(offset_for_area(hull, area))) return {};

    for (const std::size_t edges : {3U, 4U, 5U, 6U, 8U, 12U}) {
        if (edges > hull.size()) break;
        const Polygon polygon = with_fewer_edges(hull, edges);
        if (polygon.size() > edges) continue;
        const double offset = offset_for_area(polygon, area);
        if (plausible(offset)) return offset_polygon(polygon, offset);
    }
    // A round piece: its edges cross the border, no more than two per cent of the area is on the wrong side.
    const Polygon round = with_fewer_edges(hull, max_polygon_vertices);
    if (round.size() > max_polygon_vertices || polygon_area(round) > 1.02 * area) return {};
    return offset_polygon(round, offset_for_area(round, area));
}

std::vector<V2d> rough_outline(std::span<const V2d> points, double area, double spacing) {
    Polygon hull = convex_hull(hull_candidates(points));
    const bool thin = hull.size() < 3 || polygon_area(hull) < 0.05 * spacing * spacing;
    if (thin) {
        // One point, or points on a line: a strip of the right area around them.
        V2d mean(0, 0);
        for (const V2d& p : points) mean += p / static_cast<double>(points.size());
        V2d axis(1, 0);
        double reach = 0;
        for (const V2d& p : points)
            if ((p - mean).length() > reach) {
                reach = (p - mean).length();
                axis = (p - mean) / reach;
            }
        const double half_length = std::max(reach + spacing / 2, std::sqrt(area) / 2);
        const V2d u = axis * half_length;
        const V2d v = V2d(-axis.y, axis.x) * (area / (4 * half_length));
        return {mean - u - v, mean + u - v, mean + u + v, mean - u + v};
    }
    hull = with_fewer_edges(std::move(hull), 8);
    if (hull.size() > 8) hull = least_rectangle(hull);
    return offset_polygon(hull, std::clamp(offset_for_area(hull, area), 0.0, spacing));
}

OutlineCut best_cut(std::span<const V2d> points, double spacing) {
    Imath::Box2d box;
    for (const V2d& p : points) box.extendBy(p);
    const double cell = 2 * spacing;
    std::array<std::size_t, 2> cells{};
    for (int axis = 0; axis < 2; ++axis)
        cells[static_cast<std::size_t>(axis)] =
            std::min<std::size_t>(static_cast<std::size_t>(box.size()[axis] / cell) + 1, 4096);
    std::vector<char> occupied(cells[0] * cells[1], 0);
    const auto index_of = [&](const V2d& p, int axis) {
        const auto at = static_cast<std::size_t>((p[axis] - box.min[axis]) / cell);
        return std::min(at, cells[static_cast<std::size_t>(axis)] - 1);
    };
    for (const V2d& p : points) occupied[index_of(p, 1) * cells[0] + index_of(p, 0)] = 1;

    // Jump: cells of one slice without their like in the next one. The longer side wins a tie.
    std::size_t best_jump = 0;
    OutlineCut cut{box.size().x >= box.size().y ? 0 : 1, 0};
    cut.position = box.center()[cut.axis];
    for (const int axis : {cut.axis, 1 - cut.axis}) {
        const std::size_t slices = cells[static_cast<std::size_t>(axis)];
        const std::size_t across = cells[static_cast<std::size_t>(1 - axis)];
        const auto at = [&](std::size_t slice, std::size_t k) {
            return occupied[axis == 0 ? k * cells[0] + slice : slice * cells[0] + k] != 0;
        };
        // The outermost slices are cut by a border that is never quite parallel to them.
        for (std::size_t slice = 1; slice + 2 < slices; ++slice) {
            std::size_t ends = 0;
            std::size_t begins = 0;
            for (std::size_t k = 0; k < across; ++k) {
                ends += at(slice, k) && !at(slice + 1, k) ? 1 : 0;
                begins += !at(slice, k) && at(slice + 1, k) ? 1 : 0;
            }
            const std::size_t jump = std::max(ends, begins);
            if (jump <= best_jump) continue;
            best_jump = jump;
            // The border runs along the last points of the rows that end (or the first of those that begin).
            const bool ending = ends >= begins;
            double border = ending ? std::numeric_limits<double>::lowest() : std::numeric_limits<double>::max();
            for (const V2d& p : points) {
                const std::size_t k = index_of(p, 1 - axis);
                const std::size_t own = index_of(p, axis);
                if (at(slice, k) == at(slice + 1, k) || own != (ending ? slice : slice + 1)) continue;
                border = ending ? std::max(border, p[axis]) : std::min(border, p[axis]);
            }
            const double margin = 0.05 * spacing;
            cut = {axis, border + (ending ? margin : -margin)};
        }
    }
    return cut;
}

}  // namespace vmap
