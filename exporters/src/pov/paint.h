// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How the colours of a mesh are said in POV-Ray's language.
#pragma once

#include <vmap/scene.h>

#include <Imath/ImathColor.h>
#include <Imath/ImathVec.h>

#include <cstddef>
#include <string>

namespace vmap {

enum class PaintKind {
    plain,       ///< one colour
    per_vertex,  ///< vertex colours, nothing else that varies
    image,       ///< images that the texture coordinates of the mesh look up
    tiles        ///< everything else: an image with a tile for each triangle of the mesh
};

/// What is to be seen on a mesh. Meshes with equal paints share them, unless they are tiled.
struct Paint {
    PaintKind kind = PaintKind::plain;
    std::size_t material = 0;     ///< index into Scene::materials
    Imath::C4f tint{1, 1, 1, 1};  ///< vertex colour where it does not vary
    TextureView view;             ///< image: how all images are looked up; its image sets the resolution
    bool has_albedo_image = false;
    bool has_emission_image = false;
    bool visible = true;  ///< false where an alpha mask cuts everything
};

[[nodiscard]] Paint choose_paint(const Scene& scene, const Mesh& mesh);

/// Albedo of a plain material under a vertex colour, in [0, 1].
[[nodiscard]] Imath::C3f plain_albedo(const Material& material, const Imath::C4f& vertex_color);

/// A colour, or an image by its name.
struct PovPigment {
    Imath::C3f color{0, 0, 0};
    std::string image;     ///< file name, sRGB; empty: the colour
    bool nearest = false;  ///< texels instead of interpolation
};

/// What lies between the braces of `texture { }`: a surface that reflects the pigment and emits.
///
/// - emission: radiance
/// - emission_image: file name of an image that multiplies emission, sRGB; may be empty
[[nodiscard]] std::string texture_body(const PovPigment& albedo, const Imath::C3f& emission,
                                       const std::string& emission_image);

/// The same for the back of a single-sided surface: black, cut away where the pigment's image is.
[[nodiscard]] std::string back_texture_body(const PovPigment& albedo, bool masked);

}  // namespace vmap
