// SPDX-License-Identifier: GPL-3.0-or-later
#include "points.h"

#include "../content_error.h"
#include "../warnings.h"
#include "accessor.h"
#include "limits.h"
#include "linear_part.h"
#include "vertex_reader.h"

#include <vmap/axes.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace vmap::gltf {
namespace {

using Imath::C3f;
using Imath::C4f;
using Imath::M44d;
using Imath::V3d;
using Imath::V3f;

C3f as_color(const V3f& v) {
    return {v.x, v.y, v.z};
}

bool turns_nothing(const M44d& m) {
    const M44d unit;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            if (m[row][column] != unit[row][column]) return false;
    return true;
}

/// A unit normal in the world; the very same numbers where nothing turns it and it is of unit length already.
V3f placed_normal(const V3f& normal, const M44d& m, bool unturned) {
    constexpr double rounding = 1e-5;
    const V3d turned = unturned ? V3d(normal) : transformed_normal(m, normal);
    if (unturned && std::abs(turned.length2() - 1) < rounding) return normal;
    return V3f(turned.normalized());
}

bool usable(const std::vector<V3f>& normals) {
    return std::all_of(normals.begin(), normals.end(), [](const V3f& normal) {
        const double squares = V3d(normal).length2();
        return std::isfinite(squares) && squares > 0;
    });
}

}  // namespace

template <class Value, class Source, class Convert>
void PointCollector::append(Column<Value>& column, const std::vector<Source>& source,
                            const std::vector<std::uint32_t>& sequence, const Convert& convert) const {
    if (source.empty() || !column.complete) {
        column.complete = false;
        return;
    }
    column.values.reserve(column.values.size() + sequence.size());
    for (const std::uint32_t i : sequence) column.values.push_back(convert(source[i]));
}

template <class Value>
std::vector<Value> PointCollector::take(Column<Value>& column) const {
    return column.complete ? std::move(column.values) : std::vector<Value>();
}

std::vector<float> PointCollector::areas_of(const MeshInfo& mesh, const Primitive& primitive,
                                            std::uint64_t stored_count) {
    if (!mesh.areas && !(mesh.radius && *mesh.radius > 0)) return {};
    buffers_.spend(stored_count, sizeof(float));
    if (!mesh.areas) {
        const auto area = static_cast<float>(std::numbers::pi * *mesh.radius * *mesh.radius);
        return std::vector<float>(stored_count, area);
    }
    const Accessor& accessor = document_.accessors[*mesh.areas];
    std::vector<float> areas(stored_count, 0.0F);
    if (accessor.count == stored_count && accessor.components == 1)
        read_floats(open_accessor(accessor, buffers_), {}, 1, areas);
    if (!std::all_of(areas.begin(), areas.end(), [](float area) { return std::isfinite(area) && area > 0; }))
        throw BrokenContent(fmt::format("the extras 'areas' of the mesh of {} are not one area above 0 for each point",
                                        primitive.where));
    return areas;
}

std::vector<C3f> PointCollector::albedo_of(const Primitive& primitive, VertexReader& reader) {
    std::vector<C3f> albedo;
    C3f factor(1, 1, 1);
    std::vector<V3f> own = reader.vectors("_ALBEDO");
    if (!own.empty()) {
        std::transform(own.begin(), own.end(), std::back_inserter(albedo), as_color);
    } else {
        const std::vector<C4f> colors = reader.colors();
        std::transform(colors.begin(), colors.end(), std::back_inserter(albedo),
                       [](const C4f& c) { return C3f(c.r, c.g, c.b); });
        if (primitive.material) {
            const C4f& base = document_.materials[*primitive.material].base_color;
            factor = C3f(base.r, base.g, base.b);
        }
    }
    bool clamped = false;
    for (C3f& color : albedo)
        for (int i = 0; i < 3; ++i) {
            const float value = color[i] * factor[i];
            color[i] = std::clamp(value, 0.0F, 1.0F);
            clamped = clamped || color[i] != value;
        }
    if (clamped) warnings_.add("colours of points outside 0 to 1 are clamped", primitive.where);
    return albedo;
}

void PointCollector::add(const MeshInfo& mesh, const Primitive& primitive, const std::vector<double>& weights,
                         const M44d& world_from_mesh) {
    VertexReader reader(document_, primitive, weights, buffers_);
    if (reader.stored_count() == 0) {
        warnings_.add("primitives without positions are left out", primitive.where);
        return;
    }
    const std::vector<std::uint32_t> stored = reader.sequence();
    if (stored.size() > std::numeric_limits<std::uint32_t>::max() - positions_.size())
        throw UnsupportedContent("it has more points than have 32-bit numbers");
    std::vector<std::uint32_t> sequence = stored;
    reader.keep_used(sequence);
    buffers_.spend(sequence.size(), 2 * sizeof(V3f) + sizeof(float) + 3 * sizeof(C3f));

    const UpAxis up = document_.own ? document_.own->up : UpAxis::y;
    const bool unturned = turns_nothing(world_from_mesh);
    M44d relative = world_from_mesh;
    if (positions_.empty()) origin_ = world_from_mesh.translation();
    for (int i = 0; i < 3; ++i) relative[3][i] -= origin_[i];
    const std::vector<V3f> positions = reader.positions();
    positions_.reserve(positions_.size() + sequence.size());
    for (const std::uint32_t i : sequence) {
        const V3d place = V3d(positions[i]) * relative;
        if (!(std::abs(place.x) < largest_coordinate && std::abs(place.y) < largest_coordinate &&
              std::abs(place.z) < largest_coordinate))
            throw UnsupportedContent(fmt::format("{} has points beyond {:.0e}", primitive.where, largest_coordinate));
        positions_.push_back(world_from_file(up, V3f(place)));
    }

    std::vector<V3f> normals = reader.vectors("_NORMAL");
    if (normals.empty()) normals = reader.normals();
    if (!usable(normals)) {
        warnings_.add("normals of points are not used: some are zero or not finite", primitive.where);
        normals.clear();
    }
    append(normals_, normals, sequence,
           [&](const V3f& normal) { return world_from_file(up, placed_normal(normal, world_from_mesh, unturned)); });
    const auto same = [](const auto& value) { return value; };
    append(areas_, areas_of(mesh, primitive, reader.stored_count()), stored, same);
    append(albedo_, albedo_of(primitive, reader), sequence, same);
    append(emission_, reader.vectors("_EMISSION"), sequence, as_color);
    append(irradiance_, reader.vectors("_IRRADIANCE"), sequence, as_color);
}

std::optional<PointFile> PointCollector::finish() {
    if (positions_.empty()) return std::nullopt;
    PointFile file;
    PointCloud& points = file.cloud.points;
    points.origin = world_from_file(document_.own ? document_.own->up : UpAxis::y, origin_);
    points.positions = std::move(positions_);
    points.normals = take(normals_);
    points.areas = take(areas_);
    points.albedo = take(albedo_);
    points.emission = take(emission_);
    file.cloud.irradiance = take(irradiance_);
    if (!document_.own) return file;
    file.ours = !points.normals.empty() && !points.areas.empty() && !points.albedo.empty();
    file.light_units = document_.own->light_units;
    file.exposure = document_.own->exposure;
    file.source = document_.own->source;
    return file;
}

}  // namespace vmap::gltf
