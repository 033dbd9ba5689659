// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh_scene.h"

#include "obj_materials.h"
#include "orient_triangles.h"
#include "triangulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <span>
#include <unordered_map>
#include <utility>

namespace vmap {
namespace {

using Imath::V3d;
using Imath::V3f;

/// A triangle of the soup: places of its corners in the soup's arrays of corners, and the polygon it is a part of.
struct CornerTriangle {
    std::array<std::uint32_t, 3> corners;
    std::uint32_t polygon = 0;
};

struct DropCounts {
    std::size_t short_polygons = 0;
    std::size_t flat_polygons = 0;
    std::size_t crossing_polygons = 0;
};

class SoupTriangulator {
public:
    SoupTriangulator(const PolygonSoup& soup, DropCounts& drops) : soup_(soup), drops_(drops) {}

    std::vector<CornerTriangle> run() {
        triangles_.reserve(soup_.polygon_sizes.size());
        std::uint32_t first = 0;
        for (std::uint32_t polygon = 0; polygon < soup_.polygon_sizes.size(); ++polygon) {
            const std::uint32_t size = soup_.polygon_sizes[polygon];
            if (size < 3)
                ++drops_.short_polygons;
            else
                add_polygon(polygon, first, size);
            first += size;
        }
        return std::move(triangles_);
    }

private:
    void add_polygon(std::uint32_t polygon, std::uint32_t first, std::uint32_t size) {
        positions_.clear();
        for (std::uint32_t k = 0; k < size; ++k)
            positions_.emplace_back(soup_.positions.offsets[soup_.corners[first + k]]);
        pieces_.clear();
        if (!triangulate_polygon(positions_, pieces_)) ++drops_.crossing_polygons;
        const std::size_t before = triangles_.size();
        for (const auto& piece : pieces_) {
            const V3d& a = positions_[piece[0]];
            if ((positions_[piece[1]] - a).cross(positions_[piece[2]] - a) == V3d(0, 0, 0)) continue;
            triangles_.push_back({{first + piece[0], first + piece[1], first + piece[2]}, polygon});
        }
        // A polygon with corners on a straight line loses nothing by the triangles without area there.
        if (triangles_.size() == before) ++drops_.flat_polygons;
    }

    const PolygonSoup& soup_;
    DropCounts& drops_;
    std::vector<CornerTriangle> triangles_;
    std::vector<V3d> positions_;
    std::vector<std::array<std::uint32_t, 3>> pieces_;
};

struct PositionHash {
    std::size_t operator()(const V3f& v) const {
        std::uint64_t hash = 0;
        for (const float value : {v.x, v.y, v.z}) {
            std::uint32_t bits = 0;
            const float plain = value + 0.0F;  // -0 is 0
            std::memcpy(&bits, &plain, sizeof bits);
            hash = (hash ^ bits) * 0x9E3779B97F4A7C15U;
            hash ^= hash >> 29U;
        }
        return hash;
    }
};

/// For each position the first one that equals it.
std::vector<std::uint32_t> weld(std::span<const V3f> positions) {
    std::unordered_map<V3f, std::uint32_t, PositionHash> first;
    first.reserve(positions.size());
    std::vector<std::uint32_t> same(positions.size());
    for (std::uint32_t i = 0; i < positions.size(); ++i) same[i] = first.try_emplace(positions[i], i).first->second;
    return same;
}

void make_consistent(const PolygonSoup& soup, std::vector<CornerTriangle>& triangles, Warnings& warnings) {
    const std::vector<std::uint32_t> same = weld(soup.positions.offsets);
    std::vector<IndexTriangle> indices;
    indices.reserve(triangles.size());
    for (const CornerTriangle& t : triangles)
        indices.push_back(
            {same[soup.corners[t.corners[0]]], same[soup.corners[t.corners[1]]], same[soup.corners[t.corners[2]]]});
    const Orientation orientation = orient_triangles(indices);
    for (std::size_t i = 0; i < triangles.size(); ++i)
        if (orientation.flip[i]) std::swap(triangles[i].corners[1], triangles[i].corners[2]);
    if (orientation.flipped > 0)
        warnings.add(
            fmt::format("{} triangles are wound against their neighbours: turned around", orientation.flipped));
    if (orientation.unorientable > 0)
        warnings.add(fmt::format("the surface has no consistent orientation at {} edges", orientation.unorientable));
}

/// What makes a vertex of the mesh: the same corner data, the same vertex.
struct VertexKey {
    std::uint32_t position = 0;
    std::uint32_t normal = no_index;
    std::uint32_t texcoord = no_index;
    std::uint32_t polygon = no_index;  ///< only where polygons have colours

    friend bool operator==(const VertexKey&, const VertexKey&) = default;
};

struct VertexKeyHash {
    std::size_t operator()(const VertexKey& key) const {
        std::uint64_t hash = key.position;
        for (const std::uint32_t part : {key.normal, key.texcoord, key.polygon})
            hash = (hash ^ (hash >> 31U) ^ part) * 0x9E3779B97F4A7C15U;
        return hash ^ (hash >> 29U);
    }
};

/// Builds the mesh of one material.
class MeshBuilder {
public:
    explicit MeshBuilder(const PolygonSoup& soup) : soup_(soup) {
        if (!soup.texcoords.empty()) mesh_.texcoords.resize(1);
    }

    void add(const CornerTriangle& triangle) {
        for (const std::uint32_t corner : triangle.corners)
            mesh_.indices.push_back(vertex(key_of(corner, triangle.polygon)));
    }

    Mesh finish() {
        // A normal that some corners lack is no use: the sampler falls back to the triangle's own.
        if (incomplete_normals_) mesh_.normals.clear();
        return std::move(mesh_);
    }

private:
    [[nodiscard]] VertexKey key_of(std::uint32_t corner, std::uint32_t polygon) const {
        VertexKey key{.position = soup_.corners[corner]};
        if (!soup_.normals.empty())
            key.normal = soup_.corner_normals.empty() ? key.position : soup_.corner_normals[corner];
        if (!soup_.texcoords.empty())
            key.texcoord = soup_.corner_texcoords.empty() ? key.position : soup_.corner_texcoords[corner];
        if (!soup_.polygon_colors.empty()) key.polygon = polygon;
        return key;
    }

    std::uint32_t vertex(const VertexKey& key) {
        const auto [known, is_new] = vertices_.try_emplace(key, static_cast<std::uint32_t>(mesh_.positions.size()));
        if (is_new) append(key);
        return known->second;
    }

    void append(const VertexKey& key) {
        mesh_.positions.push_back(soup_.positions.offsets[key.position]);
        if (!soup_.normals.empty()) {
            const V3f normal = key.normal == no_index ? V3f(0, 0, 0) : soup_.normals[key.normal];
            const bool usable = normal.dot(normal) > 0 && std::isfinite(normal.dot(normal));
            incomplete_normals_ = incomplete_normals_ || !usable;
            mesh_.normals.push_back(usable ? normal.normalized() : V3f(0, 0, 0));
        }
        if (!soup_.texcoords.empty())
            mesh_.texcoords[0].push_back(key.texcoord == no_index ? Imath::V2f(0, 0) : soup_.texcoords[key.texcoord]);
        if (key.polygon != no_index)
            push_color(soup_.polygon_colors[key.polygon]);
        else if (!soup_.colors.empty())
            push_color(soup_.colors[key.position]);
    }

    void push_color(const Imath::C3f& color) { mesh_.colors.emplace_back(color.x, color.y, color.z, 1.0F); }

    const PolygonSoup& soup_;
    Mesh mesh_;
    std::unordered_map<VertexKey, std::uint32_t, VertexKeyHash> vertices_;
    bool incomplete_normals_ = false;
};

Imath::M44d world_from_mesh(UpAxis up, const V3d& origin) {
    const V3d x = world_from_file(up, V3d(1, 0, 0));
    const V3d y = world_from_file(up, V3d(0, 1, 0));
    const V3d z = world_from_file(up, V3d(0, 0, 1));
    const V3d t = world_from_file(up, origin);
    return {x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, t.x, t.y, t.z, 1};
}

void warn_of_drops(const DropCounts& drops, Warnings& warnings) {
    if (drops.short_polygons > 0)
        warnings.add(fmt::format("{} faces with fewer than 3 vertices: dropped", drops.short_polygons));
    if (drops.flat_polygons > 0) warnings.add(fmt::format("{} faces without area: dropped", drops.flat_polygons));
    if (drops.crossing_polygons > 0)
        warnings.add(fmt::format("{} faces that cross themselves: cut into triangles as well as can be",
                                 drops.crossing_polygons));
}

}  // namespace

Scene scene_from_soup(MeshFile& file) {
    const PolygonSoup& soup = file.soup;
    DropCounts drops;
    std::vector<CornerTriangle> triangles = SoupTriangulator(soup, drops).run();
    warn_of_drops(drops, file.warnings);
    if (!triangles.empty()) make_consistent(soup, triangles, file.warnings);

    Scene scene;
    scene.materials = file.materials;
    scene.images = std::move(file.images);
    if (scene.materials.empty())
        scene.materials.push_back(default_material(!soup.colors.empty() || !soup.polygon_colors.empty()));

    const auto material_of = [&](const CornerTriangle& t) {
        return soup.polygon_materials.empty() ? 0U : soup.polygon_materials[t.polygon];
    };
    std::vector<MeshBuilder> builders(scene.materials.size(), MeshBuilder(soup));
    for (const CornerTriangle& t : triangles) builders[material_of(t)].add(t);
    for (std::size_t material = 0; material < builders.size(); ++material) {
        Mesh mesh = builders[material].finish();
        if (mesh.indices.empty()) continue;
        mesh.name = scene.materials[material].name;
        mesh.material = material;
        scene.instances.push_back({mesh.name, scene.meshes.size(), world_from_mesh(file.up, soup.positions.origin)});
        scene.meshes.push_back(std::move(mesh));
    }
    return scene;
}

}  // namespace vmap
