// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the chunks of a .vmap file hold. One description serves for measuring, writing and reading: an archive is
/// handed every value in turn and counts, writes or fills it.
#pragma once

#include <vmap/vmap_file.h>

#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace vmap {

static_assert(std::endian::native == std::endian::little,
              "the file is little-endian, like every host it was written on");

/// Structs that go to the file as they lie in memory have no gaps, and this layout.
static_assert(sizeof(TreeNode) == 64 && sizeof(TreeLeaf) == 40);
static_assert(sizeof(Imath::V3f) == 12 && sizeof(Imath::V3i) == 12 && sizeof(Imath::C3f) == 12);

/// An archive has value(T&) for plain values, and array(T&) for vectors and strings of plain values.
template <class Archive, class Contents>
void info_chunk(Archive& archive, Contents& c) {
    archive.array(c.source);
    auto units = static_cast<std::uint32_t>(c.light_units);
    archive.value(units);
    if constexpr (Archive::reads) c.light_units = archive.checked_enum(units, LightUnits::raw);
    archive.value(c.tree_seconds);
    archive.value(c.map_seconds);
}

template <class Archive, class Contents>
void cloud_chunk(Archive& archive, Contents& c) {
    archive.value(c.cloud.origin);
    archive.array(c.cloud.positions);
    archive.array(c.cloud.normals);
    archive.array(c.cloud.areas);
    archive.array(c.cloud.albedo);
    archive.array(c.cloud.emission);
    archive.array(c.cloud.faces);
    archive.array(c.cloud.materials);
}

template <class Archive, class Light>
void one_light(Archive& archive, Light& light) {
    auto kind = static_cast<std::uint32_t>(light.kind);
    archive.value(kind);
    if constexpr (Archive::reads) light.kind = archive.checked_enum(kind, LightKind::sun);
    archive.array(light.name);
    archive.value(light.position);
    archive.value(light.direction);
    archive.value(light.intensity);
    archive.value(light.inner_cone_angle);
    archive.value(light.outer_cone_angle);
}

template <class Archive, class View>
void one_camera(Archive& archive, View& camera) {
    archive.array(camera.name);
    archive.value(camera.world_from_camera);
    auto orthographic = static_cast<std::uint32_t>(camera.orthographic);
    archive.value(orthographic);
    if constexpr (Archive::reads) camera.orthographic = orthographic != 0;
    archive.value(camera.vertical_fov);
    archive.value(camera.half_height);
    archive.value(camera.aspect);
}

template <class Archive, class Contents>
void lights_chunk(Archive& archive, Contents& c) {
    archive.list(c.lights, [&](auto& light) { one_light(archive, light); });
}

template <class Archive, class Contents>
void cameras_chunk(Archive& archive, Contents& c) {
    archive.list(c.cameras, [&](auto& camera) { one_camera(archive, camera); });
}

template <class Archive, class Contents>
void tree_chunk(Archive& archive, Contents& c) {
    archive.array(c.tree.nodes);
    archive.array(c.tree.leaves);
    archive.array(c.tree.point_order);
    archive.array(c.tree.cells);
}

template <class Archive, class Contents>
void links_chunk(Archive& archive, Contents& c) {
    auto rule = static_cast<std::uint32_t>(c.map.rule);
    archive.value(rule);
    if constexpr (Archive::reads) c.map.rule = archive.checked_enum(rule, VisibilityRule::patch);
    archive.array(c.map.first_link);
    archive.array(c.map.partners);
    archive.array(c.map.first_hidden);
    archive.array(c.map.hidden);
}

/// A patch in the file.
struct PatchRecord {
    std::array<Imath::V3f, 4> frame;  ///< center, normal, u, v
    std::uint32_t first_point;
    std::uint32_t point_count;
    float area;
    std::uint32_t kind;  ///< 1 flat, 2 emits, or the sum of both
    std::uint32_t vertices;
};
static_assert(sizeof(PatchRecord) == 68);

/// The order of the patches' points is that of the tree.
template <class Archive, class Contents>
void patches_chunk(Archive& archive, Contents& c) {
    std::vector<PatchRecord> records;
    std::vector<Imath::V3f> vertices;
    if constexpr (!Archive::reads) {
        for (std::size_t p = 0; p < c.patches.patches.size(); ++p) {
            const Patch& patch = c.patches.patches[p];
            const auto outline = c.patches.outlines[p];
            records.push_back({{patch.center, patch.normal, patch.u, patch.v},
                               patch.first_point,
                               patch.point_count,
                               patch.area,
                               (patch.flat ? 1U : 0U) + (patch.emits ? 2U : 0U),
                               static_cast<std::uint32_t>(outline.size())});
            vertices.insert(vertices.end(), outline.begin(), outline.end());
        }
    }
    archive.array(records);
    archive.array(vertices);
    if constexpr (Archive::reads) {
        std::size_t next = 0;
        for (const PatchRecord& r : records) {
            archive.require(r.vertices >= 3 && r.vertices <= max_polygon_vertices &&
                            r.vertices <= vertices.size() - next && r.kind < 4);
            c.patches.outlines.add(std::span(vertices).subspan(next, r.vertices));
            next += r.vertices;
            c.patches.patches.push_back({r.frame[0], r.frame[1], r.frame[2], r.frame[3], r.first_point, r.point_count,
                                         r.area, (r.kind & 1) != 0, (r.kind & 2) != 0});
        }
        archive.require(next == vertices.size());
    }
}

/// Calls visit(name, describe) for every chunk in the order of the file, where describe(archive, contents) hands the
/// chunk's values to the archive.
template <class Visit>
void for_each_chunk(const Visit& visit) {
    visit("INFO", [](auto& archive, auto& c) { info_chunk(archive, c); });
    visit("CLOU", [](auto& archive, auto& c) { cloud_chunk(archive, c); });
    visit("LGTS", [](auto& archive, auto& c) { lights_chunk(archive, c); });
    visit("CAMS", [](auto& archive, auto& c) { cameras_chunk(archive, c); });
    visit("TREE", [](auto& archive, auto& c) { tree_chunk(archive, c); });
    visit("LINK", [](auto& archive, auto& c) { links_chunk(archive, c); });
    visit("PTCH", [](auto& archive, auto& c) { patches_chunk(archive, c); });
}

}  // namespace vmap
