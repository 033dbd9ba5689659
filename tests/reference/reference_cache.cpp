// SPDX-License-Identifier: GPL-3.0-or-later
#include <reference/content_key.h>
#include <reference/reference_cache.h>
#include <vmap/exporters/file_writer.h>

#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <type_traits>

namespace vmap::reference {
namespace {

/// Counts up whenever values for the same question change.
constexpr std::uint64_t tracer_version = 1;

void add(ContentKey& key, const std::optional<TextureView>& view) {
    key.add(view.has_value());
    if (!view) return;
    key.add(view->image);
    key.add(view->texcoord_set);
    key.add(view->wrap_u);
    key.add(view->wrap_v);
    key.add(view->nearest);
    key.add_bytes(&view->image_from_texcoord, sizeof view->image_from_texcoord);
}

void add(ContentKey& key, const Material& material) {
    key.add(material.base_color);
    add(key, material.base_color_texture);
    key.add(material.metallic);
    add(key, material.metallic_texture);
    key.add(material.emission);
    add(key, material.emission_texture);
    key.add(material.alpha_mode);
    key.add(material.alpha_cutoff);
    key.add(material.double_sided);
}

void add(ContentKey& key, const LightSource& light) {
    key.add(light.kind);
    key.add(light.position);
    key.add(light.direction);
    key.add(light.intensity);
    key.add(light.inner_cone_angle);
    key.add(light.outer_cone_angle);
}

void add(ContentKey& key, const Scene& scene) {
    for (const Mesh& mesh : scene.meshes) {
        key.add_all(mesh.positions);
        key.add_all(mesh.colors);
        key.add_all(mesh.indices);
        for (const std::vector<Imath::V2f>& texcoords : mesh.texcoords) key.add_all(texcoords);
        key.add(mesh.material);
    }
    for (const Instance& instance : scene.instances) {
        key.add(instance.mesh);
        key.add_bytes(&instance.world_from_mesh, sizeof instance.world_from_mesh);
    }
    for (const Material& material : scene.materials) add(key, material);
    for (const Image& image : scene.images) {
        key.add(image.width);
        key.add_all(image.rgba);
    }
    for (const LightSource& light : scene.lights) add(key, light);
}

std::string key_of(const Scene& scene, std::span<const ReferencePoint> points, const ReferenceConfig& config) {
    ContentKey key;
    key.add(tracer_version);
    add(key, scene);
    for (const ReferencePoint& point : points) {
        key.add(point.position);
        key.add(point.normal);
        key.add(point.face);
    }
    key.add(config.samples);
    key.add(config.max_bounces);
    key.add(config.sky);
    key.add(config.seed);
    return key.text();
}

static_assert(std::is_standard_layout_v<ReferenceValue> && sizeof(ReferenceValue) == 7 * sizeof(float));

std::optional<std::vector<ReferenceValue>> read_values(const std::filesystem::path& file, std::size_t count) {
    std::ifstream stream(file, std::ios::binary);
    std::vector<ReferenceValue> values(count);
    const auto size = static_cast<std::streamsize>(count * sizeof(ReferenceValue));
    if (!stream.read(reinterpret_cast<char*>(values.data()), size) || stream.peek() != EOF) return std::nullopt;
    return values;
}

}  // namespace

std::vector<ReferenceValue> cached_irradiance(const std::filesystem::path& folder, const Scene& scene,
                                              std::span<const ReferencePoint> points, const ReferenceConfig& config,
                                              const ProgressCallback& progress) {
    if (folder.empty()) return trace_irradiance(scene, points, config, progress);
    const std::filesystem::path file = folder / (key_of(scene, points, config) + ".irradiance");
    if (auto kept = read_values(file, points.size())) return *kept;

    std::vector<ReferenceValue> values = trace_irradiance(scene, points, config, progress);
    std::filesystem::create_directories(folder);
    FileWriter writer(file.string(), Durability::fast);
    writer.write(values.data(), values.size() * sizeof(ReferenceValue));
    writer.commit();
    return values;
}

}  // namespace vmap::reference
