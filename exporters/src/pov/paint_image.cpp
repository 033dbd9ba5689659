// SPDX-License-Identifier: GPL-3.0-or-later
#include "paint_image.h"

#include "wrapped_image.h"

#include <vmap/srgb.h>
#include <vmap/texture.h>

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace vmap {
namespace {

using Imath::C3f;
using Imath::C4f;
using Imath::V2d;

std::uint16_t srgb16_from_linear(float linear) {
    const double clamped = linear > 0 ? std::min(linear, 1.0F) : 0;
    const double encoded = clamped <= 0.0031308 ? clamped * 12.92 : 1.055 * std::pow(clamped, 1 / 2.4) - 0.055;
    return static_cast<std::uint16_t>(std::lround(encoded * 65535));
}

/// Fills an image with color(x, y), linear; alpha is kept in images of four channels.
template <class Color>
PaintImage fill_image(int width, int height, int channels, int bits, const Color& color) {
    PaintImage image{.width = width, .height = height, .channels = channels, .bits_per_sample = bits, .bytes = {}};
    const std::size_t pixel_size = static_cast<std::size_t>(channels) * static_cast<std::size_t>(bits / 8);
    image.bytes.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * pixel_size);
    tbb::parallel_for(0, height, [&](int y) {
        std::uint8_t* out =
            image.bytes.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width) * pixel_size;
        const auto put = [&](std::uint16_t sample) {
            if (bits == 16) *out++ = static_cast<std::uint8_t>(sample >> 8);
            *out++ = static_cast<std::uint8_t>(sample & 0xFF);
        };
        for (int x = 0; x < width; ++x) {
            const C4f value = color(x, y);
            for (const float sample : {value.r, value.g, value.b})
                put(bits == 16 ? srgb16_from_linear(sample) : srgb8_from_linear(sample));
            if (channels == 4) put(value.a > 0 ? (bits == 16 ? 0xFFFF : 0xFF) : 0);
        }
    });
    return image;
}

/// Reads an image at the texels of another one, which may have a different size.
class ResampledImage {
public:
    ResampledImage(const Image& image, TexelMeaning meaning, const TextureView& view, const Image& reference)
        : image_(image), meaning_(meaning), width_(reference.width), height_(reference.height) {
        if (image.width == width_ && image.height == height_) return;
        pyramid_.emplace(image, meaning);
        view_.wrap_u = view.wrap_u;
        view_.wrap_v = view.wrap_v;
        view_.nearest = view.nearest;
    }

    [[nodiscard]] C4f at(int x, int y) const {
        if (pyramid_) return pyramid_->at(view_, V2d((x + 0.5) / width_, (y + 0.5) / height_));
        const std::uint8_t* bytes = &image_.rgba[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                                                      static_cast<std::size_t>(x))];
        const auto linear = [&](std::uint8_t sample) {
            return meaning_ == TexelMeaning::data ? static_cast<float>(sample) / 255 : linear_from_srgb8(sample);
        };
        return {linear(bytes[0]), linear(bytes[1]), linear(bytes[2]), static_cast<float>(bytes[3]) / 255};
    }

private:
    const Image& image_;
    TexelMeaning meaning_;
    int width_;
    int height_;
    TextureView view_;
    std::optional<TexturePyramid> pyramid_;
};

/// Longest edge of a mesh's triangles in the texels of an image.
double longest_edge(const Scene& scene, const Mesh& mesh, const TextureView& view) {
    const auto set = static_cast<std::size_t>(view.texcoord_set);
    if (set >= mesh.texcoords.size() || mesh.texcoords[set].empty()) return 0;
    const Image& image = scene.images[view.image];
    double longest = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
        const V2d edge = image_coordinate(view, mesh.texcoords[set][mesh.indices[next]]) -
                         image_coordinate(view, mesh.texcoords[set][mesh.indices[i]]);
        longest = std::max(longest, std::hypot(edge.x * image.width, edge.y * image.height));
    }
    return longest;
}

/// Barycentric coordinates of a texel of a tile; those beyond the triangle are moved to its edge.
Imath::V3d barycentric_at(int x, int y, int tile_size) {
    double b = static_cast<double>(x) / (tile_size - 1);
    double c = static_cast<double>(y) / (tile_size - 1);
    if (b + c > 1) {
        const double sum = b + c;
        b /= sum;
        c /= sum;
    }
    return {1 - b - c, b, c};
}

}  // namespace

PaintImage image_of_paint(const Scene& scene, const Paint& paint, PaintLayer layer) {
    const Material& material = scene.materials[paint.material];
    const TextureView& view = paint.view;
    const Image& reference = scene.images[view.image];
    const auto reader = [&](const std::optional<TextureView>& texture, TexelMeaning meaning) {
        std::optional<ResampledImage> image;
        if (texture) image.emplace(scene.images[texture->image], meaning, view, reference);
        return image;
    };
    const auto base = reader(material.base_color_texture, TexelMeaning::color);
    const auto metal = reader(material.metallic_texture, TexelMeaning::data);
    const auto emission = reader(material.emission_texture, TexelMeaning::color);

    const bool masked = material.alpha_mode == AlphaMode::mask && base;
    const C4f factor = material.base_color * paint.tint;
    const C4f white(1, 1, 1, 1);
    const auto color = [&](int extended_x, int extended_y) {
        const int x = source_texel(view.wrap_u, extended_x, reference.width);
        const int y = source_texel(view.wrap_v, extended_y, reference.height);
        const C4f base_color = (base ? base->at(x, y) : white) * factor;
        C4f result = white;
        if (layer == PaintLayer::albedo)
            result = base_color * (1 - material.metallic * (metal ? metal->at(x, y).b : 1));
        else if (emission)
            result = emission->at(x, y);
        result.a = base_color.a < material.alpha_cutoff ? 0.0F : 1.0F;
        return result;
    };
    const bool as_in_source = factor.r == 1 && factor.g == 1 && factor.b == 1 && material.metallic == 0;
    return fill_image(extended_size(view.wrap_u, reference.width), extended_size(view.wrap_v, reference.height),
                      masked ? 4 : 3, layer == PaintLayer::emission || as_in_source ? 8 : 16, color);
}

std::array<Imath::V2d, 3> TileLayout::corners(std::size_t triangle) const {
    const auto column = static_cast<double>(triangle % static_cast<std::size_t>(columns));
    const auto row = static_cast<double>(triangle / static_cast<std::size_t>(columns));
    const V2d first(column * tile_size + 0.5, row * tile_size + 0.5);
    const double length = tile_size - 1;
    const V2d size(width(), height());
    return {first / size, (first + V2d(length, 0)) / size, (first + V2d(0, length)) / size};
}

TileLayout layout_tiles(const Scene& scene, const Mesh& mesh) {
    constexpr double texel_limit = 1 << 24;
    constexpr double largest_tile = 2048;
    const Material& material = scene.materials[mesh.material];
    double wanted = 8;
    for (const auto& view : {material.base_color_texture, material.metallic_texture, material.emission_texture})
        if (view) wanted = std::max(wanted, 1 + longest_edge(scene, mesh, *view));

    const auto count = static_cast<double>(mesh.triangle_count());
    const double affordable = std::floor(std::sqrt(texel_limit / count));
    TileLayout layout;
    layout.tile_size = static_cast<int>(std::clamp(std::min(wanted, affordable), 2.0, largest_tile));
    layout.columns = static_cast<int>(std::ceil(std::sqrt(count)));
    layout.rows = static_cast<int>(std::ceil(count / layout.columns));
    return layout;
}

PaintImage tiles_of_paint(const SurfaceShading& shading, std::size_t instance, const TileLayout& layout,
                          PaintLayer layer) {
    const Scene& scene = shading.scene();
    const Mesh& mesh = scene.meshes[scene.instances[instance].mesh];
    const Material& material = scene.materials[mesh.material];
    const bool masked = material.alpha_mode == AlphaMode::mask;
    const auto color = [&](int x, int y) {
        const auto tile = static_cast<std::size_t>(y / layout.tile_size) * static_cast<std::size_t>(layout.columns) +
                          static_cast<std::size_t>(x / layout.tile_size);
        if (tile >= mesh.triangle_count()) return C4f(0, 0, 0, 1);
        const SurfacePlace place{
            .instance = instance,
            .triangle = tile,
            .barycentric = barycentric_at(x % layout.tile_size, y % layout.tile_size, layout.tile_size)};
        C3f value = shading.albedo(place);
        if (layer == PaintLayer::emission) {
            const C3f emission = shading.emission(place);
            for (int channel = 0; channel < 3; ++channel)
                value[channel] = material.emission[channel] > 0 ? emission[channel] / material.emission[channel] : 0;
        }
        return C4f(value.x, value.y, value.z, shading.is_cut(place) ? 0.0F : 1.0F);
    };
    return fill_image(layout.width(), layout.height(), masked ? 4 : 3, 16, color);
}

}  // namespace vmap
