// SPDX-License-Identifier: GPL-3.0-or-later
#include <vmap/importers/gltf.h>
#include <vmap/importers/input.h>

#include "content_error.h"
#include "file_bytes.h"
#include "input_format.h"
#include "mesh/mesh_scene.h"
#include "mesh/obj.h"
#include "mesh/off.h"
#include "mesh/ply.h"
#include "mesh/stl.h"
#include "mesh/xyz.h"
#include "scene_folder.h"

#include <vmap/error.h>
#include <vmap/printable.h>
#include <vmap/vmap_file.h>

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace vmap {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t largest_file = std::uint64_t{64} << 30U;
constexpr std::uint64_t head_size = 4096;

/// Text without the mark that some editors put in front of UTF-8; formats of text hold no zero bytes.
std::string_view plain_text(std::string_view content) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (content.starts_with(byte_order_mark)) content.remove_prefix(byte_order_mark.size());
    if (content.find('\0') != content.npos) throw BrokenContent("holds zero bytes, expected text");
    return content;
}

MeshFile read_mesh_file(InputFormat format, std::string_view content, const fs::path& path) {
    switch (format) {
        case InputFormat::ply:
            return read_ply(content);
        case InputFormat::stl:
            return read_stl(content);
        case InputFormat::off:
            return read_off(plain_text(content));
        case InputFormat::obj:
            return read_obj(plain_text(content), SceneFolder(path));
        default:
            return read_xyz(plain_text(content));
    }
}

/// Foreign files may hold normals of any length, and zeros for normals that were not found.
void make_unit_or_leave_out(std::vector<Imath::V3f>& normals, Warnings& warnings) {
    for (Imath::V3f& normal : normals) {
        const Imath::V3d exact(normal);
        const double length = exact.length();
        if (!(length > 0) || !std::isfinite(length)) {
            warnings.add("some normals of points are zero or not finite: no normal is read");
            normals.clear();
            return;
        }
        normal = Imath::V3f(exact / length);
    }
}

/// The vertices as points, turned into the world.
PointFile points_from_soup(MeshFile& file) {
    PointFile points = file.points ? std::move(*file.points) : PointFile();
    PointCloud& cloud = points.cloud.points;
    const UpAxis up = file.up;
    cloud.origin = world_from_file(up, cloud.origin + file.soup.positions.origin);
    cloud.positions = std::move(file.soup.positions.offsets);
    cloud.normals = std::move(file.soup.normals);
    if (!points.ours) make_unit_or_leave_out(cloud.normals, file.warnings);
    for (Imath::V3f& position : cloud.positions) position = world_from_file(up, position);
    for (Imath::V3f& normal : cloud.normals) normal = world_from_file(up, normal);
    if (cloud.albedo.empty()) cloud.albedo = std::move(file.soup.colors);
    return points;
}

Input input_from_mesh_file(MeshFile file, const InputConfig& config) {
    if (config.up && !(file.points && file.points->ours)) file.up = *config.up;
    Input input;
    input.facts = {file.format, file.up, file.soup.positions.size(), file.polygons};
    if (!file.soup.polygon_sizes.empty()) input.scene = scene_from_soup(file);
    if (input.scene.instances.empty()) {
        if (!file.soup.polygon_sizes.empty())
            file.warnings.add("no face has an area: the vertices are taken as points");
        if (file.soup.positions.size() == 0) throw UnsupportedContent("holds neither surface nor points");
        input.points = points_from_soup(file);
    }
    input.scene.warnings = file.warnings.lines();
    return input;
}

Input input_from_vmap(const fs::path& path) {
    VmapContents contents = read_vmap(path);
    if (contents.cloud.empty()) throw UnsupportedContent("holds no points");
    Input input;
    input.facts = {"vmap", UpAxis::y, contents.cloud.size(), 0};
    input.scene.lights = std::move(contents.lights);
    input.scene.cameras = std::move(contents.cameras);
    input.points.emplace();
    input.points->cloud.points = std::move(contents.cloud);
    input.points->ours = true;
    input.points->light_units = contents.light_units;
    input.points->source = std::move(contents.source);
    return input;
}

Input read_content(const fs::path& path, const InputConfig& config) {
    const FileHead head = read_file_head(path, head_size);
    const InputFormat format = recognize_format(as_text(head.bytes.span()), head.size, path);
    if (format == InputFormat::gltf) return import_gltf(path, config);
    if (format == InputFormat::vmap) return input_from_vmap(path);
    const Bytes bytes = read_file(path, largest_file);
    const std::string_view content = as_text(bytes.span());
    Input input = input_from_mesh_file(read_mesh_file(format, content, path), config);
    input.scene.source = printable(path.filename().string());
    return input;
}

}  // namespace

Input read_input(const fs::path& file, const InputConfig& config) {
    const auto message = [&](const char* problem) {
        return fmt::format("{}: {}", printable(file.string()), printable(problem));
    };
    try {
        return read_content(file, config);
    } catch (const BrokenContent& error) {
        throw FileError(message(error.what()));
    } catch (const UnsupportedContent& error) {
        throw UnsupportedInput(message(error.what()));
    }
}

}  // namespace vmap
