// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Writes one lit cloud and one picture in every format, and what they hold as JSON: write_samples FOLDER
#include <vmap/exporters/exr.h>
#include <vmap/exporters/gltf_points.h>
#include <vmap/exporters/ply.h>
#include <vmap/exporters/png.h>
#include <vmap/exporters/vdb_grid.h>
#include <vmap/exporters/vdb_points.h>

#include <nlohmann/json.hpp>

#include <exception>
#include <filesystem>
#include <functional>
#include <iostream>
#include <string>

namespace vmap {
namespace {

using Imath::C3f;
using Imath::V3f;

constexpr float spacing = 0.1F;

/// A floor of 4 x 2 units (facing up, y) and a wall of 4 x 1 at its back (facing +z), no two axes alike. E is in the
/// ratio 3 : 2 : 1; one point is as bright as 1e4.
LitCloud floor_and_wall() {
    LitCloud cloud;
    const auto add = [&](const V3f& position, const V3f& normal, float brightness) {
        cloud.points.positions.push_back(position);
        cloud.points.normals.push_back(normal);
        cloud.points.areas.push_back(spacing * spacing);
        cloud.points.albedo.emplace_back(0.8F, 0.4F, 0.2F);
        cloud.points.emission.emplace_back(0.0F, 0.0F, 0.0F);
        cloud.points.faces.push_back(static_cast<std::uint32_t>(cloud.points.faces.size()));
        cloud.points.materials.push_back(7);
        cloud.irradiance.push_back(C3f(3, 2, 1) * brightness);
    };
    const auto place = [](int i) { return (static_cast<float>(i) + 0.5F) * spacing; };
    for (int x = 0; x < 40; ++x) {
        for (int z = 0; z < 20; ++z) add({place(x), 0, place(z)}, {0, 1, 0}, 1);
        for (int y = 0; y < 10; ++y) add({place(x), place(y), 0}, {0, 0, 1}, 2);
    }
    cloud.irradiance[5] = {1e4F, 1e-4F, 0};
    cloud.points.emission[5] = {1, 2, 3};
    return cloud;
}

Picture gradient() {
    Picture picture;
    picture.width = 6;
    picture.height = 4;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 6; ++x)
            picture.pixels.emplace_back(static_cast<float>(x) / 5, static_cast<float>(y) / 3, 0.25F);
    picture.pixels[23] = {1e4F, 0, 0};
    return picture;
}

nlohmann::json json_of(const std::vector<V3f>& values) {
    nlohmann::json rows = nlohmann::json::array();
    for (const V3f& value : values) rows.push_back({value.x, value.y, value.z});
    return rows;
}

nlohmann::json json_of(const std::vector<C3f>& values) {
    return json_of(std::vector<V3f>(values.begin(), values.end()));
}

void write(const std::string& path, const std::function<void(FileWriter&)>& content) {
    FileWriter file(path);
    content(file);
    file.commit();
}

void write_all(const std::string& folder) {
    std::filesystem::create_directories(folder);
    const LitCloud cloud = floor_and_wall();
    OutputInfo y_up;
    y_up.source = "floor and wall";
    y_up.exposure = 0.5;
    OutputInfo z_up = y_up;
    z_up.up = UpAxis::z;

    write(folder + "/lit.ply", [&](FileWriter& file) { write_ply(file, cloud, z_up); });
    write(folder + "/lit.glb", [&](FileWriter& file) { write_gltf_points(file, cloud, y_up); });
    write(folder + "/lit.gltf", [&](FileWriter& file) {
        write_gltf_points(file, cloud, y_up, {.container = GltfContainer::embedded, .normals = true});
    });
    write(folder + "/empty.glb", [&](FileWriter& file) { write_gltf_points(file, {}, y_up); });
    write(folder + "/empty.ply", [&](FileWriter& file) { write_ply(file, {}, z_up); });
    write(folder + "/lit.vdb", [&](FileWriter& file) { write_vdb_grid(file, cloud, z_up); });
    write(folder + "/points.vdb", [&](FileWriter& file) { write_vdb_points(file, cloud, z_up); });
    write(folder + "/empty.vdb", [&](FileWriter& file) { write_vdb_grid(file, {}, z_up); });
    write(folder + "/picture.exr", [&](FileWriter& file) { write_exr(file, gradient(), y_up); });
    write(folder + "/picture.png", [&](FileWriter& file) { write_png(file, gradient(), y_up); });

    const nlohmann::json expected = {
        {"positions", json_of(cloud.points.positions)},
        {"normals", json_of(cloud.points.normals)},
        {"albedo", json_of(cloud.points.albedo)},
        {"emission", json_of(cloud.points.emission)},
        {"irradiance", json_of(cloud.irradiance)},
        {"areas", cloud.points.areas},
        {"exposure", y_up.exposure},
        {"voxel_size", default_voxel_size(cloud.points)},
        {"picture", json_of(gradient().pixels)},
    };
    write(folder + "/expected.json", [&](FileWriter& file) { file.stream() << expected.dump(); });
}

}  // namespace
}  // namespace vmap

int main(int count, char** arguments) {
    if (count != 2) {
        std::cerr << "usage: foreign_samples FOLDER\n";
        return 2;
    }
    try {
        vmap::write_all(arguments[1]);
    } catch (const std::exception& error) {
        std::cerr << error.what() << '\n';
        return 1;
    }
    return 0;
}
