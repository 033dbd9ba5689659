// SPDX-License-Identifier: GPL-3.0-or-later
// samplers, textures, images and materials: the diffuse and the emitting part of every surface.
#include "../content_error.h"
#include "../warnings.h"
#include "document_parts.h"
#include "json_object.h"

#include <vmap/printable.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vmap::gltf {
namespace {

constexpr std::size_t most_texcoord_sets = 16;

/// A sampler and an image. Without an image it shows nothing.
struct Texture {
    std::optional<std::size_t> image;
    WrapMode wrap_u = WrapMode::repeat;
    WrapMode wrap_v = WrapMode::repeat;
    bool nearest = false;
};

WrapMode read_wrap(const JsonObject& sampler, const char* key) {
    switch (sampler.integer(key, 0, 0xFFFF).value_or(10497)) {
        case 10497:
            return WrapMode::repeat;
        case 33648:
            return WrapMode::mirrored_repeat;
        case 33071:
            return WrapMode::clamp_to_edge;
        default:
            sampler.fail(key, "10497, 33648 or 33071");
    }
}

Texture read_sampler(const JsonObject& object) {
    constexpr std::uint64_t gl_nearest = 9728;
    Texture texture;
    texture.wrap_u = read_wrap(object, "wrapS");
    texture.wrap_v = read_wrap(object, "wrapT");
    const std::uint64_t filter = object.integer("magFilter", gl_nearest, gl_nearest + 1).value_or(gl_nearest + 1);
    texture.nearest = filter == gl_nearest;
    return texture;
}

std::vector<Texture> read_textures(const JsonObject& root, const Document& document) {
    std::vector<Texture> samplers;
    samplers.reserve(root.array_size("samplers"));
    root.for_each("samplers", [&](const JsonObject& object, std::size_t) { samplers.push_back(read_sampler(object)); });

    std::vector<Texture> textures;
    textures.reserve(root.array_size("textures"));
    root.for_each("textures", [&](const JsonObject& object, std::size_t) {
        const std::optional<std::size_t> sampler = object.index("sampler", samplers.size());
        Texture texture = sampler ? samplers[*sampler] : Texture{};
        texture.image = object.index("source", document.images.size());
        // A form that is not decoded is still named, so that the warning can tell which image is missing.
        for (const char* form : {"KHR_texture_basisu", "EXT_texture_webp", "EXT_texture_avif", "MSFT_texture_dds"})
            if (const auto extension = object.extension(form); extension && !texture.image)
                texture.image = extension->index("source", document.images.size());
        textures.push_back(texture);
    });
    return textures;
}

ImageInfo read_image(const JsonObject& object, const Document& document) {
    ImageInfo image;
    image.uri = object.text("uri");
    const std::optional<std::size_t> view = object.index("bufferView", document.views.size());
    if (image.uri.has_value() == view.has_value())
        throw BrokenContent(object.where() + " has a uri and a bufferView or none of both, expected one");
    image.view = view.value_or(0);
    if (const std::optional<std::string> name = object.text("name"))
        image.name = printable(*name);
    else if (image.uri && !image.uri->starts_with("data:"))
        image.name = printable(*image.uri);
    else
        image.name = object.where();
    return image;
}

/// (u, v) -> offset + rotation (scale (u, v)). Angles turn counter-clockwise as seen with v downwards.
std::array<std::array<double, 3>, 2> read_transform(const JsonObject& transform) {
    std::array<double, 2> offset{0, 0};
    std::array<double, 2> scale{1, 1};
    transform.numbers("offset", offset);
    transform.numbers("scale", scale);
    const double rotation = transform.number("rotation").value_or(0);
    const double c = std::cos(rotation);
    const double s = std::sin(rotation);
    return {{{c * scale[0], s * scale[1], offset[0]}, {-s * scale[0], c * scale[1], offset[1]}}};
}

class SurfaceReader {
public:
    SurfaceReader(const JsonObject& root, Document& document, Warnings& warnings)
        : textures_(read_textures(root, document)), warnings_(warnings) {}

    Material read_material(const JsonObject& object, std::size_t index) {
        Material material;
        material.name = printable(object.text("name").value_or(fmt::format("material {}", index)));
        read_base(object, material);
        read_emission(object, material);
        read_alpha(object, material);
        material.double_sided = object.boolean("doubleSided").value_or(false);
        if (object.extension("KHR_materials_unlit")) {
            material.metallic = 0;
            material.metallic_texture.reset();
        }
        if (read_texture(object, "normalTexture"))
            warnings_.add("normal maps are not used: light falls on the geometric surface");
        if (read_texture(object, "occlusionTexture"))
            warnings_.add("occlusion maps are not used: occlusion is computed");
        return material;
    }

private:
    std::optional<TextureView> read_texture(const JsonObject& owner, const char* key) {
        const std::optional<JsonObject> info = owner.object(key);
        if (!info) return std::nullopt;
        const Texture& texture = textures_[info->required(info->index("index", textures_.size()), "index")];
        TextureView view;
        view.wrap_u = texture.wrap_u;
        view.wrap_v = texture.wrap_v;
        view.nearest = texture.nearest;
        std::size_t set = info->index("texCoord", most_texcoord_sets).value_or(0);
        if (const auto transform = info->extension("KHR_texture_transform")) {
            view.image_from_texcoord = read_transform(*transform);
            set = transform->index("texCoord", most_texcoord_sets).value_or(set);
        }
        view.texcoord_set = static_cast<int>(set);
        if (!texture.image) {
            warnings_.add("textures without an image are left out", info->where());
            return std::nullopt;
        }
        view.image = *texture.image;
        return view;
    }

    void read_color(const JsonObject& owner, const char* key, Material& material) {
        std::array<double, 4> color{1, 1, 1, 1};
        owner.numbers(key, color, not_negative);
        if (std::any_of(color.begin(), color.end(), [](double c) { return c > 1; }))
            warnings_.add("colour factors above 1 are clamped to 1", material.name);
        for (int i = 0; i < 4; ++i) material.base_color[i] = static_cast<float>(std::min(color[i], 1.0));
    }

    void read_base(const JsonObject& object, Material& material) {
        if (const auto glossy = object.extension("KHR_materials_pbrSpecularGlossiness")) {
            read_color(*glossy, "diffuseFactor", material);
            material.base_color_texture = read_texture(*glossy, "diffuseTexture");
            material.metallic = 0;
            return;
        }
        material.metallic = 1;
        const std::optional<JsonObject> base = object.object("pbrMetallicRoughness");
        if (base) {
            read_color(*base, "baseColorFactor", material);
            material.base_color_texture = read_texture(*base, "baseColorTexture");
            material.metallic = static_cast<float>(base->number("metallicFactor", unit_interval).value_or(1));
            material.metallic_texture = read_texture(*base, "metallicRoughnessTexture");
        }
        const bool stated = base && (base->has("metallicFactor") || base->has("metallicRoughnessTexture"));
        if (object.extension("KHR_materials_unlit")) return;
        if (!stated)
            warnings_.add("a material without metallicFactor is a metal by the specification: its albedo is 0",
                          material.name);
        else if (material.metallic > 0)
            warnings_.add("reflection of metals is not modelled: they are dark", material.name);
    }

    void read_emission(const JsonObject& object, Material& material) {
        std::array<double, 3> factor{0, 0, 0};
        object.numbers("emissiveFactor", factor, not_negative);
        double strength = 1;
        if (const auto extension = object.extension("KHR_materials_emissive_strength"))
            strength = extension->number("emissiveStrength", not_negative).value_or(1);
        for (int i = 0; i < 3; ++i) {
            const double emission = factor[i] * strength;
            if (!(emission <= std::numeric_limits<float>::max()))
                throw BrokenContent(object.where() + " emits more than a float can hold");
            material.emission[i] = static_cast<float>(emission);
        }
        material.emission_texture = read_texture(object, "emissiveTexture");
        if (!material.emits()) material.emission_texture.reset();
    }

    void read_alpha(const JsonObject& object, Material& material) {
        const std::string mode = object.text("alphaMode").value_or("OPAQUE");
        if (mode == "MASK")
            material.alpha_mode = AlphaMode::mask;
        else if (mode == "BLEND")
            material.alpha_mode = AlphaMode::blend;
        else if (mode != "OPAQUE")
            object.fail("alphaMode", "OPAQUE, MASK or BLEND");
        if (mode == "BLEND")
            warnings_.add("blending by alpha is not modelled: such surfaces are opaque", material.name);
        material.alpha_cutoff = static_cast<float>(object.number("alphaCutoff", not_negative).value_or(0.5));
    }

    std::vector<Texture> textures_;
    Warnings& warnings_;
};

}  // namespace

void read_surfaces(const JsonObject& root, Document& document, Warnings& warnings) {
    document.images.reserve(root.array_size("images"));
    root.for_each("images", [&](const JsonObject& object, std::size_t) {
        document.images.push_back(read_image(object, document));
    });
    SurfaceReader reader(root, document, warnings);
    document.materials.reserve(root.array_size("materials"));
    root.for_each("materials", [&](const JsonObject& object, std::size_t index) {
        document.materials.push_back(reader.read_material(object, index));
    });
}

}  // namespace vmap::gltf
