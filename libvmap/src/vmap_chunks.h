// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the chunks of a .vmap file hold. One description serves for measuring, writing and reading: an archive is
/// handed every value in turn and counts, writes or fills it.
#pragma once

#include <vmap/vmap_file.h>

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
}

}  // namespace vmap
