// SPDX-License-Identifier: Apache-2.0
/// \file
/// A scene of meshes as the importers deliver it and the sampler and exporters read it, in the world frame of axes.h.
/// Plain data: the tree, the V-map and the light know points only and never include this header.
#pragma once

#include <vmap/light_source.h>

#include <Imath/ImathColor.h>
#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vmap {

/// An 8-bit picture, rows from the top, four bytes a pixel: red, green, blue as in the file (sRGB for colours), alpha.
struct Image {
    std::string name;
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgba;  ///< 4 * width * height bytes
};

enum class WrapMode { repeat, mirrored_repeat, clamp_to_edge };

/// How a surface looks up an image.
struct TextureView {
    std::size_t image = 0;  ///< index into Scene::images
    int texcoord_set = 0;   ///< index into Mesh::texcoords
    WrapMode wrap_u = WrapMode::repeat;
    WrapMode wrap_v = WrapMode::repeat;
    bool nearest = false;  ///< the texel itself instead of interpolation
    /// (u, v, 1) -> texture coordinates, rows of a 2x3 matrix; v runs downwards as in glTF.
    std::array<std::array<double, 3>, 2> image_from_texcoord{{{1, 0, 0}, {0, 1, 0}}};
};

enum class AlphaMode { opaque, mask, blend };

/// The diffuse part of a material. Albedo = base colour x texture x vertex colour x (1 - metallic).
struct Material {
    std::string name;
    Imath::C4f base_color{1, 1, 1, 1};  ///< linear Rec.709 and alpha
    std::optional<TextureView> base_color_texture;
    float metallic = 0;                           ///< in [0, 1]
    std::optional<TextureView> metallic_texture;  ///< its blue channel, linear
    Imath::C3f emission{0, 0, 0};                 ///< emitted radiance Le, W/(m^2 sr), strength included
    std::optional<TextureView> emission_texture;  ///< sRGB, multiplies emission
    AlphaMode alpha_mode = AlphaMode::opaque;
    float alpha_cutoff = 0.5F;  ///< alpha below it is cut away under AlphaMode::mask
    bool double_sided = false;

    [[nodiscard]] bool emits() const { return emission.x > 0 || emission.y > 0 || emission.z > 0; }
};

/// Triangles of one material in their own frame.
struct Mesh {
    std::string name;
    std::vector<Imath::V3f> positions;
    std::vector<Imath::V3f> normals;                 ///< shading normals; empty or one per position
    std::vector<std::vector<Imath::V2f>> texcoords;  ///< one array per set; each empty or one per position
    std::vector<Imath::C4f> colors;                  ///< linear; empty or one per position
    std::vector<std::uint32_t> indices;              ///< three per triangle, counter-clockwise seen from the front
    std::size_t material = 0;                        ///< index into Scene::materials

    [[nodiscard]] std::size_t triangle_count() const { return indices.size() / 3; }
};

/// A mesh placed in the world. A negative determinant mirrors it: the winding is to be flipped back.
struct Instance {
    std::string name;
    std::size_t mesh = 0;         ///< index into Scene::meshes
    Imath::M44d world_from_mesh;  ///< row vectors, as Imath has them: world = point * matrix
};

/// A camera looking down its own -Z with +Y up, as in glTF.
struct Camera {
    std::string name;
    Imath::M44d world_from_camera;  ///< row vectors
    bool orthographic = false;
    double vertical_fov = 0.8;  ///< radians; perspective only
    double half_height = 1;     ///< world units; orthographic only
    double aspect = 0;          ///< width / height; 0 when the file leaves it open
};

/// Everything that was read from one file.
struct Scene {
    std::string source;  ///< file name without its folder
    std::vector<Mesh> meshes;
    std::vector<Instance> instances;
    std::vector<Material> materials;
    std::vector<Image> images;
    std::vector<LightSource> lights;
    std::vector<Camera> cameras;
    std::vector<std::string> warnings;    ///< one line per feature that is not modelled or was mapped
    std::vector<std::string> extensions;  ///< names of the extensions that the file uses
};

}  // namespace vmap
