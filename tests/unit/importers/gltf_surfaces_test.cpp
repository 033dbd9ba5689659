// SPDX-License-Identifier: GPL-3.0-or-later
// Materials, textures and vertex colours: what becomes of them, and what is warned about.
#include "gltf_file.h"
#include "test_images.h"

#include <vmap/surface_shading.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <png.h>

#include <numbers>
#include <vector>

namespace vmap::test {
namespace {

using Imath::C3f;
using Imath::C4f;
using Imath::V2f;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A triangle with this material.
GltfFile triangle_of(const json& material) {
    GltfFile file;
    file.add("materials", material);
    file.add_triangle();
    return file;
}

/// Adds a PNG of one pixel as an image and a texture; returns the texture.
std::size_t add_pixel(GltfFile& file, const std::vector<std::uint8_t>& rgb) {
    const std::string png = png_file(1, 1, PNG_COLOR_TYPE_RGB, 8, rgb);
    const std::size_t view = file.add_view(std::as_bytes(std::span(png)));
    const std::size_t image = file.add("images", {{"bufferView", view}, {"mimeType", "image/png"}});
    return file.add("textures", {{"source", image}});
}

void add_texcoords(GltfFile& file, const char* name) {
    file.document["meshes"][0]["primitives"][0]["attributes"][name] = file.add_floats({0, 0, 1, 0, 0, 1}, "VEC2");
}

Material only_material(const GltfFile& file) {
    const Scene scene = file.import().scene;
    return scene.materials[scene.meshes[0].material];
}

TEST(GltfSurfaces, FactorsAreLinear) {
    const json material = {
        {"name", "paint"},
        {"pbrMetallicRoughness", {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}}, {"metallicFactor", 0.25}}},
        {"doubleSided", true}};
    const Material paint = only_material(triangle_of(material));
    EXPECT_EQ(paint.name, "paint");
    EXPECT_EQ(paint.base_color, C4f(0.1F, 0.2F, 0.3F, 0.4F));
    EXPECT_EQ(paint.metallic, 0.25F);
    EXPECT_TRUE(paint.double_sided);
}

TEST(GltfSurfaces, MissingMetallicFactorMeansMetal) {
    const Scene scene = triangle_of({{"pbrMetallicRoughness", json::object()}}).import().scene;
    EXPECT_EQ(scene.materials[0].metallic, 1);
    EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("metallicFactor")));
}

TEST(GltfSurfaces, MeshesWithoutMaterialGetTheDefaultOneAfterTheOthers) {
    GltfFile file;
    file.add_triangle();
    file.add_mesh({{"attributes", {{"POSITION", 0}}}});
    const Scene scene = file.import().scene;
    ASSERT_EQ(scene.materials.size(), 2);
    EXPECT_EQ(scene.meshes[1].material, 1);
    EXPECT_EQ(scene.materials[1].metallic, 1);
    EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("without a material")));
}

TEST(GltfSurfaces, EmissionIncludesItsStrength) {
    const Material lamp =
        only_material(triangle_of({{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                                   {"emissiveFactor", {1, 0.5, 0}},
                                   {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}}}}}));
    EXPECT_EQ(lamp.emission, C3f(8, 4, 0));
}

TEST(GltfSurfaces, ColoursAboveOneAreClamped) {
    const Scene scene =
        triangle_of({{"pbrMetallicRoughness", {{"baseColorFactor", {2, 0.5, 1, 1}}, {"metallicFactor", 0}}}})
            .import()
            .scene;
    EXPECT_EQ(scene.materials[0].base_color, C4f(1, 0.5F, 1, 1));
    EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("clamped")));
}

TEST(GltfSurfaces, UnlitMaterialsAreDiffuse) {
    const Material unlit = only_material(triangle_of({{"extensions", {{"KHR_materials_unlit", json::object()}}}}));
    EXPECT_EQ(unlit.metallic, 0);
}

TEST(GltfSurfaces, SpecularGlossinessGivesItsDiffuseColour) {
    const json glossy = {{"diffuseFactor", {0.2, 0.3, 0.4, 1}}};
    const Material material =
        only_material(triangle_of({{"extensions", {{"KHR_materials_pbrSpecularGlossiness", glossy}}}}));
    EXPECT_EQ(material.base_color, C4f(0.2F, 0.3F, 0.4F, 1));
    EXPECT_EQ(material.metallic, 0);
}

TEST(GltfSurfaces, AlphaModes) {
    const json base = {{"metallicFactor", 0}};
    const Material mask =
        only_material(triangle_of({{"pbrMetallicRoughness", base}, {"alphaMode", "MASK"}, {"alphaCutoff", 0.25}}));
    EXPECT_EQ(mask.alpha_mode, AlphaMode::mask);
    EXPECT_EQ(mask.alpha_cutoff, 0.25F);
    const Scene blend = triangle_of({{"pbrMetallicRoughness", base}, {"alphaMode", "BLEND"}}).import().scene;
    EXPECT_EQ(blend.materials[0].alpha_mode, AlphaMode::blend);
    EXPECT_THAT(blend.warnings, ElementsAre(HasSubstr("opaque")));
}

TEST(GltfSurfaces, TexturesKeepTheirSamplerTransformAndSet) {
    GltfFile file = triangle_of(json::object());
    add_pixel(file, {10, 20, 30});
    file.add("samplers", {{"magFilter", 9728}, {"wrapS", 33071}, {"wrapT", 33648}});
    file.document["textures"][0]["sampler"] = 0;
    file.document["materials"][0]["pbrMetallicRoughness"] = {
        {"metallicFactor", 0},
        {"baseColorTexture",
         {{"index", 0},
          {"texCoord", 0},
          {"extensions",
           {{"KHR_texture_transform",
             {{"offset", {0.5, 0.25}}, {"rotation", std::numbers::pi / 2}, {"scale", {2, 3}}, {"texCoord", 1}}}}}}}};
    add_texcoords(file, "TEXCOORD_1");
    const Scene scene = file.import().scene;
    ASSERT_TRUE(scene.materials[0].base_color_texture.has_value());
    const TextureView view = scene.materials[0].base_color_texture.value_or(TextureView());
    EXPECT_EQ(view.texcoord_set, 1);
    EXPECT_EQ(view.wrap_u, WrapMode::clamp_to_edge);
    EXPECT_EQ(view.wrap_v, WrapMode::mirrored_repeat);
    EXPECT_TRUE(view.nearest);
    // The extension's own matrix: translation * rotation * scale with rotation (cos, sin; -sin, cos).
    const auto& m = view.image_from_texcoord;
    EXPECT_NEAR(m[0][0], 0, 1e-15);
    EXPECT_NEAR(m[0][1], 3, 1e-15);
    EXPECT_NEAR(m[0][2], 0.5, 1e-15);
    EXPECT_NEAR(m[1][0], -2, 1e-15);
    EXPECT_NEAR(m[1][1], 0, 1e-15);
    EXPECT_NEAR(m[1][2], 0.25, 1e-15);
    EXPECT_TRUE(scene.meshes[0].texcoords.at(0).empty());
    EXPECT_THAT(scene.meshes[0].texcoords.at(1), ElementsAre(V2f(0, 0), V2f(1, 0), V2f(0, 1)));
    EXPECT_THAT(scene.images.at(0).rgba, ElementsAre(10, 20, 30, 255));
}

TEST(GltfSurfaces, OnlyImagesInUseAreDecoded) {
    GltfFile file;
    file.add("materials", {{"pbrMetallicRoughness", {{"metallicFactor", 0}}}});
    file.add_triangle();
    add_pixel(file, {1, 2, 3});
    const std::size_t used = add_pixel(file, {4, 5, 6});
    file.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});  // of no mesh
    file.document["materials"][0]["emissiveTexture"] = {{"index", used}};
    file.document["materials"][0]["emissiveFactor"] = {1, 1, 1};
    add_texcoords(file, "TEXCOORD_0");
    const Scene scene = file.import().scene;
    ASSERT_EQ(scene.images.size(), 1);
    EXPECT_EQ(scene.images[0].rgba[0], 4);
    EXPECT_EQ(scene.materials[0].emission_texture.value_or(TextureView{.image = 9}).image, 0);
    EXPECT_FALSE(scene.materials[1].base_color_texture.has_value());
}

TEST(GltfSurfaces, UnreadableImagesDoNotSpoilTheScene) {
    GltfFile file;
    file.add("materials", {{"pbrMetallicRoughness",
                            {{"baseColorTexture", {{"index", 0}}}, {"metallicRoughnessTexture", {{"index", 0}}}}}});
    file.add_triangle();
    add_texcoords(file, "TEXCOORD_0");
    file.add("images", {{"uri", "missing.png"}});
    file.add("textures", {{"source", 0}});
    const Scene scene = file.import().scene;
    EXPECT_THAT(scene.images, IsEmpty());
    EXPECT_FALSE(scene.materials[0].base_color_texture.has_value());
    EXPECT_EQ(scene.materials[0].metallic, 0);
    EXPECT_THAT(scene.warnings, Contains(HasSubstr("missing.png")));
}

TEST(GltfSurfaces, ImagesBesideTheFileAreFoundByTheirEncodedName) {
    const TestFolder folder;
    GltfFile file =
        triangle_of({{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"baseColorTexture", {{"index", 0}}}}}});
    add_texcoords(file, "TEXCOORD_0");
    file.add("images", {{"uri", "a%20b%2Bc+%C3%A4.png"}});
    file.add("textures", {{"source", 0}});
    write_file(folder.path() / "a b+c+ä.png", png_file(1, 1, PNG_COLOR_TYPE_GRAY, 8, {5}));
    write_file(folder.path() / "scene.gltf", file.text());
    const Scene scene = import_gltf(folder.path() / "scene.gltf").scene;
    EXPECT_THAT(scene.warnings, IsEmpty());
    EXPECT_EQ(scene.images.size(), 1);
}

TEST(GltfSurfaces, NothingOutsideTheFolderIsOpened) {
    const TestFolder folder;
    std::filesystem::create_directory(folder.path() / "inside");
    write_file(folder.path() / "secret.png", png_file(1, 1, PNG_COLOR_TYPE_GRAY, 8, {5}));
    std::filesystem::create_symlink("../secret.png", folder.path() / "inside" / "link.png");
    for (const std::string uri : {"../secret.png", "%2e%2e/secret.png", "link.png", "/etc/hostname",
                                  "file:../secret.png", "inside/../../secret.png", ".", ""}) {
        GltfFile file =
            triangle_of({{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"baseColorTexture", {{"index", 0}}}}}});
        add_texcoords(file, "TEXCOORD_0");
        file.add("images", {{"uri", uri}});
        file.add("textures", {{"source", 0}});
        write_file(folder.path() / "inside" / "scene.gltf", file.text());
        EXPECT_THAT(import_gltf(folder.path() / "inside" / "scene.gltf").scene.images, IsEmpty()) << uri;
    }
}

TEST(GltfSurfaces, VertexColoursOfAnyType) {
    GltfFile file;
    file.add_triangle();
    json& attributes = file.document["meshes"][0]["primitives"][0]["attributes"];
    const std::vector<std::uint8_t> bytes{255, 0, 51, 0, 0, 255, 0, 0, 0, 0, 255, 0};
    const std::size_t view = file.add_view(bytes_of(bytes));
    file.document["bufferViews"][view]["byteStride"] = 4;
    attributes["COLOR_0"] =
        file.add("accessors",
                 {{"bufferView", view}, {"componentType", 5121}, {"type", "VEC3"}, {"count", 3}, {"normalized", true}});
    EXPECT_EQ(file.import().scene.meshes[0].colors[0], C4f(1, 0, 0.2F, 1));
    attributes["COLOR_0"] = file.add_floats({0.5F, 2, 0, 0.25F, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC4");
    EXPECT_EQ(file.import().scene.meshes[0].colors[0], C4f(0.5F, 2, 0, 0.25F));
}

TEST(GltfSurfaces, WhatIsNotModelledIsToldOnce) {
    GltfFile file;
    for (int i = 0; i < 3; ++i)
        file.add("materials", {{"pbrMetallicRoughness", {{"metallicFactor", 0}}}, {"normalTexture", {{"index", 0}}}});
    file.add_triangle();
    add_pixel(file, {128, 128, 255});
    file.document["extensionsUsed"] = {"KHR_materials_clearcoat", "KHR_materials_transmission", "VENDOR_thing"};
    EXPECT_THAT(file.import().scene.warnings,
                testing::UnorderedElementsAre(HasSubstr("normal maps"), HasSubstr("clear coat"),
                                              HasSubstr("transmission"), HasSubstr("VENDOR_thing")));
}

}  // namespace
}  // namespace vmap::test
