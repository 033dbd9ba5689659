// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_builder.h"

#include "../content_error.h"
#include "../warnings.h"
#include "images.h"
#include "instancing.h"
#include "limits.h"
#include "linear_part.h"
#include "node_graph.h"
#include "points.h"
#include "triangles.h"

#include <Imath/ImathBox.h>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace vmap::gltf {
namespace {

using Imath::M44d;
using Imath::V3d;

bool within_reach(const V3d& p) {
    return std::abs(p.x) < largest_coordinate && std::abs(p.y) < largest_coordinate &&
           std::abs(p.z) < largest_coordinate;
}

class SceneBuilder {
public:
    SceneBuilder(const Document& document, Buffers& buffers, const SceneFolder& folder, Warnings& warnings)
        : document_(document),
          buffers_(buffers),
          folder_(folder),
          warnings_(warnings),
          points_(document, buffers, warnings),
          shared_meshes_(document.meshes.size()) {
        scene_.materials = document.materials;
    }

    Input build(const SceneEntry& entry) {
        for (const std::uint32_t node : nodes_of(document_, entry)) add(document_.nodes[node]);
        finish_materials();
        Input input;
        for (const Mesh& mesh : scene_.meshes) {
            input.facts.vertices += mesh.positions.size();
            input.facts.polygons += mesh.triangle_count();
        }
        input.scene = std::move(scene_);
        input.points = points_.finish();
        if (input.points) input.facts.vertices += input.points->cloud.points.size();
        if (input.scene.instances.empty() && !input.points)
            throw UnsupportedContent("holds neither surface nor points");
        return input;
    }

private:
    void add(const Node& node) {
        if (node.camera != Node::none) add_camera(node);
        if (!node.visible) {
            if (node.mesh != Node::none || node.light != Node::none)
                warnings_.add("what the file hides is left out", node.name);
            return;
        }
        if (node.light != Node::none) add_light(node);
        if (node.mesh != Node::none) add_mesh(node);
    }

    void add_camera(const Node& node) {
        Camera camera = document_.cameras[node.camera];
        if (!node.name.empty()) camera.name = node.name;
        // Cameras are rigid: what scales the node does not scale the picture.
        const V3d back = axis(node.pose, 2).normalized();
        const V3d up = (axis(node.pose, 1) - back * back.dot(axis(node.pose, 1))).normalized();
        const V3d position = node.pose.translation();
        if (!within_reach(position) || !(std::abs(back.length() - 1) < 0.5) || !(std::abs(up.length() - 1) < 0.5)) {
            warnings_.add("cameras without a direction are left out", camera.name);
            return;
        }
        const V3d right = up.cross(back);
        camera.world_from_camera = M44d(right.x, right.y, right.z, 0, up.x, up.y, up.z, 0, back.x, back.y, back.z, 0,
                                        position.x, position.y, position.z, 1);
        scene_.cameras.push_back(std::move(camera));
    }

    void add_light(const Node& node) {
        LightSource light = document_.lights[node.light];
        if (!node.name.empty()) light.name = node.name;
        light.position = node.pose.translation();
        light.direction = -axis(node.pose, 2).normalized();
        const bool directed = std::abs(light.direction.length() - 1) < 0.5;
        if (!within_reach(light.position) || (light.kind != LightKind::point && !directed)) {
            warnings_.add("lights without a place or a direction are left out", light.name);
            return;
        }
        if (!directed) light.direction = V3d(0, 0, -1);
        scene_.lights.push_back(std::move(light));
    }

    void add_mesh(const Node& node) {
        const MeshInfo& info = document_.meshes[node.mesh];
        const NodeExtras none;
        const NodeExtras& extras = node.extras != nullptr ? *node.extras : none;
        // A skinned mesh is where its joints are; its node's own place does not count.
        std::vector<M44d> places{extras.skin ? M44d() : node.pose};
        if (extras.instancing) places = instance_matrices(document_, *extras.instancing, node.pose, buffers_);

        const std::vector<std::size_t> meshes = meshes_of(node);
        for (const M44d& place : places) {
            for (const std::size_t mesh : meshes) add_instance(node.name.empty() ? info.name : node.name, mesh, place);
            for (const Primitive& primitive : info.primitives)
                if (primitive.mode == PrimitiveMode::points) points_.add(info, primitive, weights_of(node), place);
        }
    }

    const std::vector<double>& weights_of(const Node& node) const {
        const bool own = node.extras != nullptr && !node.extras->weights.empty();
        return own ? node.extras->weights : document_.meshes[node.mesh].weights;
    }

    /// The scene's meshes of a node: shared by all nodes that show the same pose of it.
    std::vector<std::size_t> meshes_of(const Node& node) {
        const std::optional<std::size_t> skin = node.extras != nullptr ? node.extras->skin : std::nullopt;
        const bool own_pose = skin || (node.extras != nullptr && !node.extras->weights.empty());
        std::optional<std::vector<std::size_t>>& shared = shared_meshes_[node.mesh];
        if (!own_pose && shared) return *shared;
        Pose pose{weights_of(node), {}};
        if (skin) pose.joints = joint_matrices(document_, document_.skins[*skin], buffers_);
        std::vector<std::size_t> meshes = read_meshes(document_.meshes[node.mesh], pose);
        if (!own_pose) shared = meshes;
        return meshes;
    }

    std::vector<std::size_t> read_meshes(const MeshInfo& info, const Pose& pose) {
        std::vector<std::size_t> meshes;
        for (const Primitive& primitive : info.primitives) {
            if (primitive.mode == PrimitiveMode::points) continue;
            if (primitive.mode < PrimitiveMode::triangles) {
                warnings_.add("lines are left out: they have no surface", primitive.where);
                continue;
            }
            std::optional<Mesh> mesh = read_triangles(document_, primitive, pose, buffers_, warnings_);
            if (!mesh) continue;
            mesh->name = info.name;
            mesh->material = primitive.material ? *primitive.material : default_material();
            Imath::Box3d box;
            for (const Imath::V3f& position : mesh->positions) box.extendBy(V3d(position));
            boxes_.push_back(box);
            meshes.push_back(scene_.meshes.size());
            scene_.meshes.push_back(std::move(*mesh));
        }
        return meshes;
    }

    /// What the specification gives to primitives without a material: a white metal.
    std::size_t default_material() {
        if (!default_material_) {
            default_material_ = scene_.materials.size();
            Material& material = scene_.materials.emplace_back();
            material.name = "default";
            material.metallic = 1;
            warnings_.add("meshes without a material are white metals by the specification: their albedo is 0");
        }
        return *default_material_;
    }

    void add_instance(const std::string& name, std::size_t mesh, const M44d& world_from_mesh) {
        const Imath::Box3d& box = boxes_[mesh];
        for (int corner = 0; corner < 8; ++corner) {
            const V3d place((corner & 1) != 0 ? box.max.x : box.min.x, (corner & 2) != 0 ? box.max.y : box.min.y,
                            (corner & 4) != 0 ? box.max.z : box.min.z);
            if (!within_reach(place * world_from_mesh))
                throw UnsupportedContent(fmt::format("'{}' reaches beyond {:.0e}", name, largest_coordinate));
        }
        if (volume_factor(world_from_mesh) == 0) warnings_.add("objects are flattened by a scale of 0", name);
        if (scene_.instances.size() >= most_instances)
            throw UnsupportedContent(fmt::format("places more than {} meshes", most_instances));
        faces_ += scene_.meshes[mesh].triangle_count();
        if (faces_ > most_faces) throw UnsupportedContent(fmt::format("places more than {} triangles", most_faces));
        scene_.instances.push_back({name, mesh, world_from_mesh});
    }

    /// The textures of a material.
    static std::array<std::optional<TextureView>*, 3> textures_of(Material& material) {
        return {&material.base_color_texture, &material.metallic_texture, &material.emission_texture};
    }

    /// Decodes the images of the materials in use and leaves the others without textures.
    void finish_materials() {
        std::vector<bool> used_materials(scene_.materials.size(), false);
        for (const Mesh& mesh : scene_.meshes) used_materials[mesh.material] = true;
        std::vector<bool> used_images(document_.images.size(), false);
        for (std::size_t i = 0; i < scene_.materials.size(); ++i)
            for (std::optional<TextureView>* view : textures_of(scene_.materials[i])) {
                if (!used_materials[i]) view->reset();
                if (*view) used_images[(*view)->image] = true;
            }

        std::vector<std::optional<Image>> images = load_images(document_, used_images, buffers_, folder_, warnings_);
        std::vector<std::size_t> numbers(images.size(), 0);
        for (std::size_t i = 0; i < images.size(); ++i) {
            numbers[i] = scene_.images.size();
            if (std::optional<Image>& image = images[i]) scene_.images.push_back(std::move(*image));
        }
        for (Material& material : scene_.materials) {
            // A material whose metallic parts are not known is more often none than a metal all over.
            if (material.metallic_texture && !images[material.metallic_texture->image]) material.metallic = 0;
            for (std::optional<TextureView>* view : textures_of(material)) {
                if (!*view) continue;
                if (images[(*view)->image])
                    (*view)->image = numbers[(*view)->image];
                else
                    view->reset();
            }
        }
    }

    const Document& document_;
    Buffers& buffers_;
    const SceneFolder& folder_;
    Warnings& warnings_;
    PointCollector points_;
    Scene scene_;
    std::vector<Imath::Box3d> boxes_;                                     // one per mesh of the scene, in its frame
    std::vector<std::optional<std::vector<std::size_t>>> shared_meshes_;  // per mesh of the document
    std::optional<std::size_t> default_material_;
    std::uint64_t faces_ = 0;
};

}  // namespace

Input build_scene(const Document& document, const SceneEntry& scene, Buffers& buffers, const SceneFolder& folder,
                  Warnings& warnings) {
    return SceneBuilder(document, buffers, folder, warnings).build(scene);
}

}  // namespace vmap::gltf
