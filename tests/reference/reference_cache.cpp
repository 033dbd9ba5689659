// SPDX-License-Identifier: GPL-3.0-or-later
#include <reference/owen_sobol.h>
#include <reference/reference_cache.h>
#include <vmap/exporters/file_writer.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iomanip>
#include <optional>
#include <sstream>
#include <string>
#include <type_traits>

namespace vmap::reference {
namespace {

/// Counts up whenever values for the same question change.
constexpr std::uint64_t tracer_version = 1;

/// A hash of 128 bits over numbers in the order in which they are added.
class ContentKey {
public:
    void add_bytes(const void* data, std::size_t size) {
        add_word(size);
        const auto* bytes = static_cast<const unsigned char*>(data);
        for (std::size_t i = 0; i < size; i += 8) {
            std::uint64_t word = 0;
            std::memcpy(&word, bytes + i, std::min<std::size_t>(8, size - i));
            add_word(word);
        }
    }
    template <class T>
        requires std::is_arithmetic_v<T> || std::is_enum_v<T>
    void add(T value) {
        add_bytes(&value, sizeof value);
    }
    template <class T>
    void add(const Imath::Vec3<T>& value) {
        add_bytes(&value, sizeof value);
    }
    void add(const Imath::C4f& value) { add_bytes(&value, sizeof value); }
    template <class T>
    void add_all(const std::vector<T>& values) {
        add_bytes(values.data(), values.size() * sizeof(T));
    }

    [[nodiscard]] std::string text() const {
        std::ostringstream stream;
        stream << std::hex << std::setfill('0') << std::setw(16) << a_ << std::setw(16) << b_;
        return stream.str();
    }

private:
    void add_word(std::uint64_t word) {
        a_ = mix_keys(a_, word);
        b_ = mix_keys(b_ + word, a_);
    }

    std::uint64_t a_ = tracer_version;
    std::uint64_t b_ = 0;
};

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
