// SPDX-License-Identifier: GPL-3.0-or-later
#include "paint_image.h"

#include "wrapped_image.h"

#include <vmap/srgb.h>
#include <vmap/texture.h>

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

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

/// Reads an image by coordinates in [0, 1]: at the middle of a texel its very value.
class ImageReader {
public:
    ImageReader(const Image& image, TexelMeaning meaning, const TextureView& view) : pyramid_(image, meaning) {
        view_.wrap_u = view.wrap_u;
        view_.wrap_v = view.wrap_v;
        view_.nearest = view.nearest;
    }

    [[nodiscard]] C4f at(const V2d& coordinate) const { return pyramid_.at(view_, coordinate); }

private:
    TextureView view_;  ///< without the transform
    TexturePyramid pyramid_;
};

/// Pixels of a written image in a texel of its reference, along each axis. POV-Ray interpolates what is written: that
/// is finer than the reference for masks, whose edges it blends over a pixel, for products, and for larger images.
int oversampling_of(const Image& reference, const std::vector<const Image*>& images, bool masked) {
    constexpr double fine_enough_for_masks = 2048, largest = 8192, pixels_in_texel = 4, most = 16;
    const double reference_size = std::max(reference.width, reference.height);
    double wanted = masked ? fine_enough_for_masks / reference_size : 1;
    bool same_size = true;
    double ratio = 1;
    for (const Image* image : images) {
        same_size = same_size && image->width == reference.width && image->height == reference.height;
        ratio = std::max({ratio, static_cast<double>(image->width) / reference.width,
                          static_cast<double>(image->height) / reference.height});
    }
    if (images.size() > 1 || !same_size) wanted = std::max(wanted, pixels_in_texel * ratio);
    return static_cast<int>(std::clamp(std::min(wanted, largest / reference_size), 1.0, most));
}

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
    const bool masked = material.alpha_mode == AlphaMode::mask && material.base_color_texture;
    const bool is_albedo = layer == PaintLayer::albedo;
    std::vector<const Image*> images;
    const auto reader = [&](const std::optional<TextureView>& texture, TexelMeaning meaning, bool used) {
        std::optional<ImageReader> image;
        if (!texture || !used) return image;
        images.push_back(&scene.images[texture->image]);
        image.emplace(*images.back(), meaning, view);
        return image;
    };
    const auto base =
        reader(material.base_color_texture, masked ? TexelMeaning::cutout : TexelMeaning::color, is_albedo || masked);
    const auto metal = reader(material.metallic_texture, TexelMeaning::data, is_albedo);
    const auto emission = reader(material.emission_texture, TexelMeaning::color, !is_albedo);
    // Clamped images are extended by texels of the view's image, whatever is written.
    const bool clamps = view.wrap_u == WrapMode::clamp_to_edge || view.wrap_v == WrapMode::clamp_to_edge;
    const Image& reference = images.size() == 1 && !clamps ? *images.front() : scene.images[view.image];
    const int oversampling = oversampling_of(reference, images, masked);

    const C4f factor = material.base_color * paint.tint;
    const C4f white(1, 1, 1, 1);
    const auto color = [&](int x, int y) {
        const V2d place(source_coordinate(view.wrap_u, (x + 0.5) / oversampling, reference.width),
                        source_coordinate(view.wrap_v, (y + 0.5) / oversampling, reference.height));
        const C4f base_color = (base ? base->at(place) : white) * factor;
        C4f result = white;
        if (is_albedo)
            result = base_color * (1 - material.metallic * (metal ? metal->at(place).b : 1));
        else if (emission)
            result = emission->at(place);
        result.a = base_color.a < material.alpha_cutoff ? 0.0F : 1.0F;
        return result;
    };
    const bool as_in_source = factor.r == 1 && factor.g == 1 && factor.b == 1 && material.metallic == 0;
    return fill_image(oversampling * extended_size(view.wrap_u, reference.width),
                      oversampling * extended_size(view.wrap_v, reference.height), masked ? 4 : 3,
                      !is_albedo || as_in_source ? 8 : 16, color);
}

std::array<Imath::V2d, 3> TileLayout::corners(std::size_t triangle) const {
    const std::size_t column = triangle % static_cast<std::size_t>(columns);
    const std::size_t row = triangle / static_cast<std::size_t>(columns);
    const V2d first(static_cast<double>(column) * tile_size + 0.5, static_cast<double>(row) * tile_size + 0.5);
    const double length = tile_size - 1;
    const V2d size(width(), height());
    return {first / size, (first + V2d(length, 0)) / size, (first + V2d(0, length)) / size};
}

TileLayout layout_tiles(const Scene& scene, const Mesh& mesh) {
    constexpr double texel_limit = 1 << 24;
    constexpr double largest_tile = 2048;
    const Material& material = scene.materials[mesh.material];
    // The texels of a tile do not lie on those of the image: more of them, as long as they are few.
    constexpr double oversampling = 8, free_size = 256;
    double longest = 1;
    for (const auto& view : {material.base_color_texture, material.metallic_texture, material.emission_texture})
        if (view) longest = std::max(longest, longest_edge(scene, mesh, *view));
    const double wanted = 1 + std::max(longest, std::min(oversampling * longest, free_size));

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
