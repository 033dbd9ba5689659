// SPDX-License-Identifier: GPL-3.0-or-later
#include "rooms.h"

#include <vmap/importers/input.h>
#include <vmap/importers/sample_surface.h>

#include <Imath/ImathBox.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>

namespace vmap::bench {
namespace {

using Imath::M44d;
using Imath::V3d;
using Imath::V3f;

constexpr double model_height = 3.6;  ///< of the room's 5.5

/// A box that stands on the floor.
struct Block {
    double x, z, width, depth, height, turn;
};
constexpr std::array<Block, 12> blocks{{
    {-1.9, -2.0, 1.1, 0.9, 3.4, 0.10},
    {-0.6, -2.1, 0.9, 0.8, 1.7, -0.20},
    {0.7, -1.9, 1.0, 1.0, 2.6, 0.35},
    {2.0, -2.0, 0.9, 0.9, 4.0, -0.10},
    {-2.1, -0.6, 0.8, 1.0, 1.2, 0.25},
    {-0.8, -0.7, 0.9, 0.9, 0.8, 0.60},
    {0.5, -0.5, 0.7, 0.7, 1.9, -0.45},
    {1.9, -0.6, 1.0, 0.8, 1.4, 0.15},
    {-1.8, 0.9, 0.9, 0.8, 2.1, -0.30},
    {-0.3, 0.8, 0.8, 0.8, 1.1, 0.20},
    {1.0, 1.0, 0.9, 0.9, 0.6, -0.55},
    {2.1, 1.3, 0.7, 1.1, 2.4, 0.05},
}};

/// Four sides and a top, seen from outside.
Mesh box_mesh(const Block& block, std::size_t material) {
    Mesh mesh;
    mesh.material = material;
    for (int corner = 0; corner < 8; ++corner)
        mesh.positions.emplace_back((corner & 1) != 0 ? block.width / 2 : -block.width / 2,
                                    (corner & 2) != 0 ? block.height : 0,
                                    (corner & 4) != 0 ? block.depth / 2 : -block.depth / 2);
    for (const auto& [a, b, c, d] : std::initializer_list<std::array<std::uint32_t, 4>>{
             {0, 4, 6, 2}, {5, 1, 3, 7}, {1, 0, 2, 3}, {4, 5, 7, 6}, {6, 7, 3, 2}})
        mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
    return mesh;
}

void add_blocks(Scene& room) {
    const std::size_t white = room.meshes[0].material;
    for (const Block& block : blocks) {
        Instance& instance = room.instances.emplace_back();
        instance.name = "block";
        instance.mesh = room.meshes.size();
        instance.world_from_mesh.setEulerAngles(V3d(0, block.turn, 0));
        instance.world_from_mesh = instance.world_from_mesh * M44d().setTranslation(V3d(block.x, 0, block.z));
        room.meshes.push_back(box_mesh(block, white));
    }
}

/// Puts a model onto the middle of the floor.
void add_model(Scene& room, const Scene& model) {
    Imath::Box3d box;
    for (const Instance& instance : model.instances)
        for (const V3f& p : model.meshes[instance.mesh].positions) box.extendBy(V3d(p) * instance.world_from_mesh);
    const double scale = model_height / box.size().y;
    const V3d foot(box.center().x, box.min.y, box.center().z);
    const M44d room_from_model = M44d().setTranslation(-foot) * M44d().setScale(scale);
    const std::size_t white = room.meshes[0].material;
    for (const Instance& instance : model.instances) {
        Instance& placed = room.instances.emplace_back(instance);
        placed.mesh = room.meshes.size();
        placed.world_from_mesh = instance.world_from_mesh * room_from_model;
        Mesh& mesh = room.meshes.emplace_back(model.meshes[instance.mesh]);
        mesh.material = white;
        mesh.colors.clear();
        mesh.normals.clear();
    }
}

const std::map<std::string, std::string>& model_files() {
    static const std::map<std::string, std::string> files{{"BUN", "bunny.ply"},
                                                          {"DRA", "dragon.obj"},
                                                          {"BUD", "buddha.obj"},
                                                          {"GAN", "armadillo.off"},
                                                          {"GOD", "nefertiti.obj"}};
    return files;
}

}  // namespace

const std::vector<SeedRow>& seed_rows() {
    static const std::vector<SeedRow> rows{
        {"ECR", "empty Cornell room", 0.10, 1.40, 0.27, 79.5, 5.35, 1.09, 20.6},
        {"PCR", "packed Cornell room", 0.14, 3.85, 0.67, 82.62, 15.43, 2.68, 23.8},
        {"BUN", "bunny", 0.15, 1.53, 0.38, 74.64, 6.09, 1.50, 21.7},
        {"DRA", "dragon", 0.55, 2.75, 0.43, 84.54, 11.0, 1.70, 23.5},
        {"BUD", "Buddha", 0.67, 1.58, 0.39, 74.75, 6.33, 1.60, 23.9},
        {"GAN", "armadillo for Ganesha", 0.15, 1.56, 0.38, 75.64, 6.20, 1.55, 22.0},
        {"GOD", "bust for Satyavati", 0.17, 1.62, 0.40, 75.31, 6.40, 1.63, 22.9},
    };
    return rows;
}

double Room::spacing() const {
    double area = 0;
    for (const float a : cloud.areas) area += static_cast<double>(a);
    return std::sqrt(area / static_cast<double>(cloud.size()));
}

std::optional<Room> make_room(const SeedRow& row, std::size_t points) {
    Room room;
    room.scene = read_input(VMAP_SCENES "/cornell_empty.gltf").scene;
    if (row.name == "PCR") add_blocks(room.scene);
    if (const auto file = model_files().find(row.name); file != model_files().end()) {
        const std::filesystem::path path = std::filesystem::path(VMAP_SHARED "/models") / file->second;
        if (!std::filesystem::exists(path)) {
            std::cerr << "SKIPPED " << row.name << ": " << path << " is absent\n";
            return std::nullopt;
        }
        add_model(room.scene, read_input(path, {.scene = {}, .light_units = {}, .up = UpAxis::y}).scene);
    }
    SampleConfig config;
    config.points = points > 0 ? points : static_cast<std::size_t>(std::llround(row.points * 1e6));
    room.cloud = sample_surface(room.scene, config);
    return room;
}

}  // namespace vmap::bench
