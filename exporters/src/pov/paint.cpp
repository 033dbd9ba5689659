// SPDX-License-Identifier: GPL-3.0-or-later
#include "paint.h"

#include "pov_text.h"
#include "wrapped_image.h"

#include <algorithm>
#include <vector>

namespace vmap {
namespace {

using Imath::C3f;
using Imath::C4f;

/// Metal has no diffuse colour, whatever else is said about it.
bool is_metal(const Material& material) {
    return material.metallic >= 1 && !material.metallic_texture;
}

bool colors_vary(const Mesh& mesh, const Material& material) {
    const auto same = [&](const C4f& a, const C4f& b) {
        const bool same_color = is_metal(material) || (a.r == b.r && a.g == b.g && a.b == b.b);
        return same_color && (material.alpha_mode != AlphaMode::mask || a.a == b.a);
    };
    return std::any_of(mesh.colors.begin(), mesh.colors.end(),
                       [&](const C4f& color) { return !same(color, mesh.colors.front()); });
}

/// The views of all images that matter, the one that sets the resolution first.
std::vector<TextureView> views_of(const Material& material) {
    std::vector<TextureView> views;
    const bool masked = material.alpha_mode == AlphaMode::mask;
    if (material.base_color_texture && (masked || !is_metal(material))) views.push_back(*material.base_color_texture);
    if (material.metallic_texture) views.push_back(*material.metallic_texture);
    if (material.emission_texture && material.emits()) views.push_back(*material.emission_texture);
    return views;
}

bool look_up_alike(const TextureView& a, const TextureView& b) {
    return a.texcoord_set == b.texcoord_set && a.wrap_u == b.wrap_u && a.wrap_v == b.wrap_v && a.nearest == b.nearest &&
           a.image_from_texcoord == b.image_from_texcoord;
}

/// Whether POV-Ray's look-up gives what the view asks for, all over the mesh.
bool extended_image_suffices(const Scene& scene, const Mesh& mesh, const TextureView& view) {
    const auto set = static_cast<std::size_t>(view.texcoord_set);
    if (set >= mesh.texcoords.size() || mesh.texcoords[set].empty()) return false;
    const Image& image = scene.images[view.image];
    return std::all_of(mesh.texcoords[set].begin(), mesh.texcoords[set].end(), [&](const Imath::V2f& texcoord) {
        const Imath::V2d place = image_coordinate(view, texcoord);
        return extended_image_reaches(view.wrap_u, place.x, image.width) &&
               extended_image_reaches(view.wrap_v, place.y, image.height);
    });
}

PaintKind kind_of(const Scene& scene, const Mesh& mesh, const std::vector<TextureView>& views) {
    const Material& material = scene.materials[mesh.material];
    const bool vary = colors_vary(mesh, material);
    if (views.empty() && !vary) return PaintKind::plain;
    if (views.empty() && material.alpha_mode != AlphaMode::mask) return PaintKind::per_vertex;
    if (views.empty() || vary) return PaintKind::tiles;
    const bool alike = std::all_of(views.begin(), views.end(),
                                   [&](const TextureView& view) { return look_up_alike(view, views.front()); });
    return alike && extended_image_suffices(scene, mesh, views.front()) ? PaintKind::image : PaintKind::tiles;
}

std::string pigment_text(const PovPigment& pigment) {
    if (pigment.image.empty()) return fmt::format("pigment {{ {} }}", pov_color(pigment.color));
    return fmt::format("uv_mapping pigment {{ image_map {{ png \"{}\" gamma srgb{} }} }}", pigment.image,
                       pigment.nearest ? "" : " interpolate 2");
}

}  // namespace

Imath::C3f plain_albedo(const Material& material, const C4f& vertex_color) {
    const C4f color = material.base_color * vertex_color;
    const auto clamped = [&](float value) { return std::clamp(value * (1 - material.metallic), 0.0F, 1.0F); };
    return {clamped(color.r), clamped(color.g), clamped(color.b)};
}

Paint choose_paint(const Scene& scene, const Mesh& mesh) {
    const Material& material = scene.materials[mesh.material];
    const std::vector<TextureView> views = views_of(material);
    const bool masked = material.alpha_mode == AlphaMode::mask;

    Paint paint;
    paint.kind = kind_of(scene, mesh, views);
    paint.material = mesh.material;
    if (!mesh.colors.empty() && paint.kind != PaintKind::tiles) paint.tint = mesh.colors.front();
    if (!views.empty()) paint.view = views.front();
    if (paint.kind == PaintKind::image) {
        const bool base_matters = material.base_color_texture && (masked || !is_metal(material));
        const bool cut_by_image = masked && material.base_color_texture;
        paint.has_albedo_image = base_matters || material.metallic_texture;
        paint.has_emission_image = material.emits() && (material.emission_texture || cut_by_image);
    } else if (paint.kind == PaintKind::tiles) {
        paint.has_albedo_image = true;
        paint.has_emission_image = material.emits() && (material.emission_texture || masked);
    }
    if (masked && paint.kind != PaintKind::tiles && !material.base_color_texture)
        paint.visible = !(material.base_color.a * paint.tint.a < material.alpha_cutoff);
    return paint;
}

std::string texture_body(const PovPigment& albedo, const C3f& emission, const std::string& emission_image) {
    const C3f none(0, 0, 0);
    if (emission == none) return pigment_text(albedo);

    // POV-Ray multiplies emission by the pigment.
    constexpr float least_divisor = 1e-3F;
    if (emission_image.empty() && albedo.image.empty()) {
        if (albedo.color == none)
            return fmt::format("pigment {{ rgb 1 }} finish {{ diffuse 0 emission {} }}", pov_color(emission));
        bool divisible = true;
        C3f quotient = none;
        for (int channel = 0; channel < 3; ++channel) {
            if (emission[channel] == 0) continue;
            divisible = divisible && albedo.color[channel] >= least_divisor;
            quotient[channel] = emission[channel] / albedo.color[channel];
        }
        if (divisible) return fmt::format("{} finish {{ emission {} }}", pigment_text(albedo), pov_color(quotient));
    }
    const PovPigment emitted{.color = {1, 1, 1}, .image = emission_image, .nearest = albedo.nearest};
    return fmt::format(
        "average texture_map {{ [1 {} finish {{ diffuse 2 }}] [1 {} finish {{ diffuse 0 emission {} }}] }}",
        pigment_text(albedo), pigment_text(emitted), pov_color(emission * 2.0F));
}

std::string back_texture_body(const PovPigment& albedo, bool masked) {
    if (!masked || albedo.image.empty()) return "pigment { rgb 0 } finish { diffuse 0 }";
    return pigment_text(albedo) + " finish { diffuse 0 }";
}

}  // namespace vmap
