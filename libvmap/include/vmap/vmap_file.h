// SPDX-License-Identifier: Apache-2.0
/// \file
/// The .vmap file: points, lights, cameras, tree and visibility map, built once and used again. docs/vmap.md has
/// the layout: little-endian chunks, each with a name, a size and a checksum.
#pragma once

#include <vmap/light_source.h>
#include <vmap/light_units.h>
#include <vmap/patch.h>
#include <vmap/point_cloud.h>
#include <vmap/scene.h>
#include <vmap/tree.h>
#include <vmap/visibility_map.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace vmap {

/// Version that is written and the only one that is read.
inline constexpr std::uint32_t vmap_file_version = 1;

struct VmapContents {
    std::string source;  ///< name of the file that the points came from
    LightUnits light_units = LightUnits::compat;
    PointCloud cloud;
    std::vector<LightSource> lights;
    std::vector<Camera> cameras;
    Tree tree;  ///< over the cloud
    VisibilityMap map;
    PatchSet patches;         ///< those of the tree; empty under rule `centroid`
    double tree_seconds = 0;  ///< what building took
    double map_seconds = 0;
    std::map<std::string, std::vector<std::byte>> extra;  ///< chunks of other stages, by their four-letter name
};

/// Takes the next bytes of a file.
using ByteSink = std::function<void(std::span<const std::byte>)>;

/// Writes a .vmap file. The same contents give the same bytes.
void write_vmap(const VmapContents& contents, const ByteSink& sink);

/// Reads a .vmap file. Nothing of it is trusted: sizes are checked against the file before memory is taken, checksums
/// before the data is used, indices before it is handed out.
///
/// - throws FileError with one line for a file that cannot be read, is no .vmap file, is of another version, cut short,
///   changed or inconsistent
[[nodiscard]] VmapContents read_vmap(const std::filesystem::path& file);

/// - throws UnsupportedInput when the positions or normals are not those of the map's cloud, bit for bit
void require_same_points(const VmapContents& contents, const PointCloud& cloud, const std::string& cloud_name);

}  // namespace vmap
