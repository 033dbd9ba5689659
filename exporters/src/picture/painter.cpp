// SPDX-License-Identifier: GPL-3.0-or-later
#include "painter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace vmap::picture {
namespace {

using Imath::C3f;
using Imath::V2d;
using Imath::V3d;
using Imath::V3f;

/// Looks at one piece of surface in one pixel, at most.
constexpr std::size_t max_taps = 8;

/// At the silhouette of a curved surface some of its flat pieces turn their backs although the surface does not: backs
/// that are seen at a smaller cosine count as fronts.
constexpr double least_back_cos = 0.4;

/// Weighted sum of values. It may leave their range only as far as the place lies outside of its points.
C3f mixed(std::span<const C3f> values, const Mix& mix) {
    C3f sum(0);
    C3f low(std::numeric_limits<float>::max());
    C3f high(std::numeric_limits<float>::lowest());
    for (std::size_t i = 0; i < mix.points.size(); ++i) {
        const C3f& value = values[mix.points[i]];
        sum += value * mix.weights[i];
        for (int k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], value[k]);
            high[k] = std::max(high[k], value[k]);
        }
    }
    for (int k = 0; k < 3; ++k) {
        const float slack = mix.overhang * (high[k] - low[k]);
        sum[k] = std::clamp(sum[k], std::max(0.0F, low[k] - slack), high[k] + slack);
    }
    return sum;
}

C3f clamped(const C3f& albedo) {
    return {std::clamp(albedo.x, 0.0F, 1.0F), std::clamp(albedo.y, 0.0F, 1.0F), std::clamp(albedo.z, 0.0F, 1.0F)};
}

/// The place that stands for a piece of surface in a pixel. Of one polygon the middle of its places, which lies in it
/// as it is convex; of several the place nearest to their middle, so that no polygon is asked beyond its border.
Glimpse representative(std::span<const Glimpse> places) {
    V2d middle(0, 0);
    for (const Glimpse& glimpse : places) middle += glimpse.place;
    middle /= static_cast<double>(places.size());
    const std::uint32_t first = places[0].polygon;
    if (std::all_of(places.begin(), places.end(), [&](const Glimpse& g) { return g.polygon == first; }))
        return {first, middle};
    return *std::min_element(places.begin(), places.end(), [&](const Glimpse& a, const Glimpse& b) {
        return (a.place - middle).length2() < (b.place - middle).length2();
    });
}

}  // namespace

Painter::Painter(const LitCloud& cloud, const PointField& field, const Shapes& shapes, const View& view,
                 const RenderConfig& config, const Scene* source)
    : cloud_(cloud), field_(field), shapes_(shapes), view_(view), config_(config), source_(source) {
    if (!source) return;
    shading_.emplace(*source);
    first_face_ = first_faces(*source);
}

Painter::Sighted Painter::sighted(const Glimpse& glimpse) const {
    Sighted seen;
    seen.polygon = glimpse.polygon;
    const V3d corner(shapes_.polygons[glimpse.polygon][0]);
    seen.normal = V3d(shapes_.shapes[glimpse.polygon].normal);
    seen.front = view_.sees_front(corner, seen.normal);
    if (!seen.front) seen.normal = -seen.normal;
    const Sight sight = view_.sight(glimpse.place.x, glimpse.place.y);
    const double depth = seen.normal.dot(corner - sight.from) / seen.normal.dot(sight.along);
    seen.position = sight.from + sight.along * depth;
    seen.cos = -seen.normal.dot(sight.along) / sight.along.length();
    seen.pixel = view_.pixel_size(depth);
    return seen;
}

SurfacePlace Painter::place_on_scene(const Sighted& seen) const {
    const auto after = std::upper_bound(first_face_.begin(), first_face_.end(), std::size_t{seen.polygon});
    SurfacePlace place;
    place.instance = static_cast<std::size_t>(after - first_face_.begin()) - 1;
    place.triangle = seen.polygon - first_face_[place.instance];
    place.width = seen.pixel;

    const std::span<const V3f> corners = shapes_.polygons[seen.polygon];
    const V3d a(corners[0]);
    const V3d to_b = V3d(corners[1]) - a;
    const V3d to_c = V3d(corners[2]) - a;
    const V3d across = to_b.cross(to_c);
    const V3d p = seen.position - a;
    double b = p.cross(to_c).dot(across) / across.length2();
    double c = to_b.cross(p).dot(across) / across.length2();
    // The middle of what a pixel sees of a surface may lie a little outside of the one triangle.
    b = std::clamp(b, 0.0, 1.0);
    c = std::clamp(c, 0.0, 1.0 - b);
    if (is_mirrored(source_->instances[place.instance])) std::swap(b, c);
    place.barycentric = {1 - b - c, b, c};
    return place;
}

bool Painter::is_cut(std::uint32_t polygon, double x, double y) const {
    return shading_ && shading_->is_cut(place_on_scene(sighted({polygon, {x, y}})));
}

bool Painter::is_same_surface(const Glimpse& first, const Glimpse& second) const {
    if (first.polygon == second.polygon) return true;
    const Shape& a = shapes_.shapes[first.polygon];
    const Shape& b = shapes_.shapes[second.polygon];
    constexpr float least_cos = 0.95F;
    if (a.sheet != b.sheet || a.normal.dot(b.normal) < least_cos) return false;
    // Where the first one's plane and the second lie on the ray of sight at the second place.
    const Sighted seen = sighted(second);
    const V3d normal(a.normal);
    const double height = normal.dot(seen.position - V3d(shapes_.polygons[first.polygon][0]));
    return std::abs(height) < 0.25 * (seen.pixel + static_cast<double>(field_.spacing()));
}

bool Painter::is_rough_back(const Glimpse& glimpse) const {
    if (!is_rough(glimpse)) return false;
    const Sighted seen = sighted(glimpse);
    return !seen.front && seen.cos >= least_back_cos;
}

/// More than one look where a pixel covers several points, or a strip of a texture seen at a slant.
std::size_t Painter::taps_for(const Sighted& seen, std::size_t places) const {
    const double slant = 1 / std::max(seen.cos, 1e-3);
    double taps = seen.pixel * seen.pixel * slant / std::pow(1.5 * static_cast<double>(field_.spacing()), 2);
    if (shading_) {
        const Material& material = shading_->material(place_on_scene(seen));
        if (material.base_color_texture || material.emission_texture || material.metallic_texture)
            taps = std::max(taps, slant);
    }
    const double most = static_cast<double>(std::min(places, max_taps));
    return static_cast<std::size_t>(std::clamp(std::ceil(taps - 0.1), 1.0, most));
}

C3f Painter::color(std::span<const Glimpse> places, Workspace& workspace) const {
    const Sighted seen = sighted(representative(places));
    const std::size_t taps = taps_for(seen, places.size());
    if (taps == 1) return color_at(seen, workspace);
    C3f sum(0);
    for (std::size_t i = 0; i < taps; ++i)
        sum += color_at(sighted(places[(2 * i + 1) * places.size() / (2 * taps)]), workspace);
    return sum / static_cast<float>(taps);
}

C3f Painter::albedo_at(const Sighted& seen, const Mix& mix) const {
    if (shading_) return clamped(shading_->albedo(place_on_scene(seen)));
    return cloud_.points.albedo.empty() ? C3f(0) : clamped(mixed(cloud_.points.albedo, mix));
}

C3f Painter::emission_at(const Sighted& seen, const Mix& mix) const {
    if (!shapes_.shapes[seen.polygon].emits) return C3f(0);
    if (shading_ && seen.front) return shading_->emission(place_on_scene(seen));
    return cloud_.points.emits() && !mix.empty() ? mixed(cloud_.points.emission, mix) : C3f(0);
}

C3f Painter::color_at(const Sighted& seen, Workspace& workspace) const {
    if (config_.content == PictureContent::normals) {
        const V3d half = (seen.normal + V3d(1)) / 2;
        return C3f(V3f(half));
    }
    const Shape& shape = shapes_.shapes[seen.polygon];
    const bool grazing = shape.curved && seen.cos < least_back_cos;
    if (!seen.front && !shape.has_back && !grazing) return C3f(0);

    Mix& mix = workspace.mix;
    const bool from_scene = shading_ && config_.content == PictureContent::albedo;
    const V3d side = seen.front || shape.has_back ? seen.normal : -seen.normal;
    if (!from_scene)
        field_.mix_at({V3f(seen.position), V3f(side), shape.sheet, shape.curved}, shapes_, workspace.field, mix);
    switch (config_.content) {
        case PictureContent::albedo:
            return from_scene || !mix.empty() ? albedo_at(seen, mix) : C3f(0);
        case PictureContent::irradiance:
            return mix.empty() ? C3f(0) : mixed(cloud_.irradiance, mix);
        case PictureContent::paint:
            return mix.empty() ? C3f(0) : config_.paint[mix.nearest];
        default:
            break;
    }
    C3f radiance = emission_at(seen, mix);
    if (!mix.empty()) radiance += albedo_at(seen, mix) * mixed(cloud_.irradiance, mix) * std::numbers::inv_pi_v<float>;
    return radiance;
}

}  // namespace vmap::picture
