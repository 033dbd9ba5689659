// SPDX-License-Identifier: Apache-2.0
#include <vmap/polygon_light.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vmap {
namespace {

using Imath::V3d;

/// A convex polygon relative to the element, small enough for the stack.
struct Contour {
    static constexpr int capacity = 32;
    std::array<V3d, capacity> vertices;
    int count = 0;

    void add(const V3d& vertex) {
        if (count < capacity) vertices[static_cast<std::size_t>(count++)] = vertex;
    }
    [[nodiscard]] const V3d& operator[](int i) const { return vertices[static_cast<std::size_t>(i)]; }
};

/// Sutherland-Hodgman: the part of a polygon where normal.dot(x) > offset, and the rest if asked for.
Contour clip(const Contour& polygon, const V3d& normal, double offset, Contour* rest = nullptr) {
    Contour kept;
    if (polygon.count == 0) return kept;
    V3d previous = polygon[polygon.count - 1];
    double previous_height = previous.dot(normal) - offset;
    for (int i = 0; i < polygon.count; ++i) {
        const V3d& current = polygon[i];
        const double height = current.dot(normal) - offset;
        if ((height > 0) != (previous_height > 0)) {
            const double t = previous_height / (previous_height - height);
            const V3d crossing = previous + (current - previous) * t;
            kept.add(crossing);
            if (rest) rest->add(crossing);
        }
        if (height > 0)
            kept.add(current);
        else if (rest)
            rest->add(current);
        previous = current;
        previous_height = height;
    }
    return kept;
}

/// Angle between a and b times the unit normal of their plane. atan2 keeps small angles exact.
V3d edge_vector(const V3d& a, const V3d& b) {
    const V3d cross = a.cross(b);
    const double length = cross.length();
    return length > 0 ? cross * (std::atan2(length, a.dot(b)) / length) : V3d(0);
}

/// Seen counter-clockwise from its lit side a polygon turns against the element's normal, hence the sign.
double contour_irradiance(const Contour& contour, const V3d& normal) {
    V3d sum(0);
    for (int i = 0; i < contour.count; ++i) sum += edge_vector(contour[i], contour[(i + 1) % contour.count]);
    return std::max(-sum.dot(normal) / 2, 0.0);
}

/// Normal of the polygon's plane, not normalised.
V3d contour_normal(const Contour& contour) {
    V3d normal(0);
    for (int i = 1; i + 1 < contour.count; ++i) normal += (contour[i] - contour[0]).cross(contour[i + 1] - contour[0]);
    return normal;
}

Contour relative(std::span<const V3d> vertices, const V3d& position) {
    Contour contour;
    for (const V3d& v : vertices) contour.add(v - position);
    return contour;
}

constexpr std::size_t most_pieces = 48;

/// What is left of the pieces outside the pyramid that the blocker spans with the element.
void subtract(std::vector<Contour>& pieces, const Contour& blocker) {
    const bool faces = contour_normal(blocker).dot(blocker[0]) < 0;
    std::vector<Contour> left;
    for (const Contour& piece : pieces) {
        Contour inside = piece;
        for (int i = 0; i < blocker.count && inside.count >= 3; ++i) {
            const V3d& a = blocker[i];
            const V3d& b = blocker[(i + 1) % blocker.count];
            // Points into the pyramid, whichever way the blocker turns.
            const V3d inwards = faces ? b.cross(a) : a.cross(b);
            const double length = inwards.length();
            if (!(length > 0)) continue;
            Contour outside;
            inside = clip(inside, inwards / length, 0, &outside);
            if (outside.count >= 3) left.push_back(outside);
        }
    }
    pieces = std::move(left);
}

}  // namespace

double polygon_irradiance(const V3d& position, const V3d& normal, std::span<const V3d> vertices) {
    if (vertices.size() < 3) return 0;
    return contour_irradiance(clip(relative(vertices, position), normal, 0), normal);
}

std::optional<double> visible_polygon_irradiance(const V3d& position, const V3d& normal, std::span<const V3d> light,
                                                 std::span<const std::vector<V3d>> blockers, double clearance) {
    const Contour whole = clip(relative(light, position), normal, 0);
    if (whole.count < 3) return 0;
    const V3d light_normal = contour_normal(whole).normalized();
    const double light_offset = light_normal.dot(whole[0]);
    if (light_offset >= 0) return 0;

    std::vector<Contour> pieces{whole};
    for (const std::vector<V3d>& vertices : blockers) {
        // Between the horizon and the light's plane; the margin keeps what touches the light from hiding it.
        Contour blocker = clip(relative(vertices, position), normal, clearance);
        if (blocker.count < 3) continue;
        blocker = clip(blocker, light_normal, light_offset * (1 - 1e-6));
        if (blocker.count < 3) continue;
        subtract(pieces, blocker);
        if (pieces.empty()) return 0;
        if (pieces.size() > most_pieces) return {};
    }
    double sum = 0;
    for (const Contour& piece : pieces) sum += contour_irradiance(piece, normal);
    return sum;
}

}  // namespace vmap
