// SPDX-License-Identifier: GPL-3.0-or-later
#include <crosscheck/cases.h>
#include <vmap/importers/input.h>

#include <Imath/ImathBox.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace vmap::crosscheck {
namespace {

using Imath::V3d;
using Imath::V3f;

PovPreset preset_of(const std::string& name) {
    if (name == "draft") return PovPreset::draft;
    if (name == "normal") return PovPreset::normal;
    if (name == "reference") return PovPreset::reference;
    throw std::runtime_error("preset " + name + ", expected draft, normal or reference");
}

void read_config(const nlohmann::json& json, CrosscheckConfig& config) {
    config.direct_only = json.value("direct_only", config.direct_only);
    config.bounces = json.value("bounces", config.bounces);
    config.points = json.value("points", config.points);
    config.truth_samples = json.value("truth_samples", config.truth_samples);
    if (json.contains("preset")) config.preset = preset_of(json.at("preset"));
}

void add_rectangle(Mesh& mesh, const V3f& corner, const V3f& first, const V3f& second) {
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    for (const V3f& p : {corner, corner + first, corner + first + second, corner + second}) mesh.positions.push_back(p);
    for (const std::uint32_t i : {0U, 1U, 2U, 0U, 2U, 3U}) mesh.indices.push_back(base + i);
}

void place(Scene& scene, Mesh mesh, const Imath::C3f& albedo, const Imath::C3f& emission = {0, 0, 0}) {
    Material material;
    material.base_color = {albedo.x, albedo.y, albedo.z, 1};
    material.emission = emission;
    mesh.material = scene.materials.size();
    scene.materials.push_back(material);
    scene.instances.push_back({.name = "part", .mesh = scene.meshes.size(), .world_from_mesh = Imath::M44d()});
    scene.meshes.push_back(std::move(mesh));
}

/// A model that stands on the floor of an open-fronted room of 2 x 2 x 2 under a lamp of half its width.
Scene room_around(const Mesh& model) {
    Scene scene;
    scene.source = "bunny_room";
    Mesh walls;
    add_rectangle(walls, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
    add_rectangle(walls, {-1, 2, -1}, {2, 0, 0}, {0, 0, 2});
    add_rectangle(walls, {-1, 0, -1}, {2, 0, 0}, {0, 2, 0});
    place(scene, walls, {0.7F, 0.7F, 0.7F});
    Mesh left;
    add_rectangle(left, {-1, 0, -1}, {0, 2, 0}, {0, 0, 2});
    place(scene, left, {0.6F, 0.1F, 0.1F});
    Mesh right;
    add_rectangle(right, {1, 0, -1}, {0, 0, 2}, {0, 2, 0});
    place(scene, right, {0.1F, 0.5F, 0.1F});
    Mesh lamp;
    add_rectangle(lamp, {-0.5F, 1.999F, -0.5F}, {1, 0, 0}, {0, 0, 1});
    place(scene, lamp, {0, 0, 0}, {5, 5, 5});

    Imath::Box3f box;
    for (const V3f& p : model.positions) box.extendBy(p);
    const float scale = 1.2F / (box.max.y - box.min.y);
    const V3f foot((box.min.x + box.max.x) / 2, box.min.y, (box.min.z + box.max.z) / 2);
    Mesh standing = model;
    for (V3f& p : standing.positions) p = (p - foot) * scale;
    place(scene, standing, {0.6F, 0.55F, 0.5F});

    Camera camera;
    camera.world_from_camera.setTranslation(V3d(0, 1, 4.2));
    camera.vertical_fov = 2 * std::atan(1.02 / 3.2);
    camera.aspect = 4.0 / 3;
    scene.cameras = {camera};
    return scene;
}

}  // namespace

std::vector<Case> read_cases(const std::filesystem::path& file) {
    std::ifstream stream(file);
    const nlohmann::json json = nlohmann::json::parse(stream);
    std::vector<Case> cases;
    for (const nlohmann::json& entry : json.at("cases")) {
        Case item;
        item.name = entry.at("name");
        item.scene = entry.at("scene");
        item.about = entry.at("about");
        read_config(entry, item.config);
        item.slow = item.config;
        item.slow.whole_truth = true;
        item.slow.truth_samples = 1024;
        if (entry.contains("slow")) read_config(entry.at("slow"), item.slow);
        for (const auto& [name, limits] : entry.at("limits").items())
            item.limits[name] = {.median = limits.at("median"), .p95 = limits.at("p95")};
        cases.push_back(std::move(item));
    }
    return cases;
}

std::optional<Scene> scene_of(const Case& item, const std::filesystem::path& scenes,
                              const std::filesystem::path& models) {
    if (item.scene != "bunny_room") return read_input(scenes / item.scene).scene;
    const std::filesystem::path bunny = models / "bunny.ply";
    if (!std::filesystem::exists(bunny)) return std::nullopt;
    return room_around(read_input(bunny, {.scene = std::nullopt, .light_units = LightUnits::compat, .up = UpAxis::y})
                           .scene.meshes.at(0));
}

std::map<std::string, DifferenceFigures> figures_of(const Crosscheck& check) {
    return {{"picture", check.picture},
            {"ply", check.ply},
            {"vdb", check.vdb},
            {"ours", check.our_error},
            {"povray", check.povray_error}};
}

}  // namespace vmap::crosscheck
