// SPDX-License-Identifier: GPL-3.0-or-later
#include <vmap/surface_shading.h>

#include <gtest/gtest.h>

namespace vmap {
namespace {

using Imath::C3f;
using Imath::C4f;
using Imath::M44d;
using Imath::V2f;
using Imath::V3d;
using Imath::V3f;

/// A unit right triangle in the plane z = 0 that faces +z, textured by its own x and y.
Scene triangle_scene(const M44d& world_from_mesh = M44d()) {
    Mesh mesh;
    mesh.positions = {V3f(0, 0, 0), V3f(1, 0, 0), V3f(0, 1, 0)};
    mesh.texcoords = {{V2f(0, 0), V2f(1, 0), V2f(0, 1)}};
    mesh.indices = {0, 1, 2};
    Scene scene;
    scene.meshes = {mesh};
    scene.materials = {Material{}};
    scene.instances = {{.name = "one", .mesh = 0, .world_from_mesh = world_from_mesh}};
    return scene;
}

M44d scaled(double x, double y, double z) {
    M44d m;
    m.setScale(V3d(x, y, z));
    return m;
}

Image two_texels(std::array<std::uint8_t, 4> left, std::array<std::uint8_t, 4> right) {
    return {.name = "two",
            .width = 2,
            .height = 1,
            .rgba = {left[0], left[1], left[2], left[3], right[0], right[1], right[2], right[3]}};
}

TEST(WorldAreaNormal, MirroredInstanceKeepsItsOutwardNormal) {
    EXPECT_EQ(world_area_normal(triangle_scene(), 0, 0), V3d(0, 0, 1));
    EXPECT_EQ(world_area_normal(triangle_scene(scaled(-2, 3, 1)), 0, 0), V3d(0, 0, 6));
    EXPECT_EQ(world_area_normal(triangle_scene(scaled(1, 1, -1)), 0, 0), V3d(0, 0, -1));
}

TEST(FirstFaces, CountOverInstancesOfSharedMeshes) {
    Scene scene = triangle_scene();
    scene.instances.push_back(scene.instances[0]);
    EXPECT_EQ(first_faces(scene), (std::vector<std::size_t>{0, 1, 2}));
    EXPECT_EQ(first_faces(Scene{}), (std::vector<std::size_t>{0}));
}

TEST(SurfaceShading, AlbedoIsTheProductOfItsFactors) {
    Scene scene = triangle_scene();
    scene.materials[0].base_color = C4f(0.5F, 0.25F, 1, 1);
    scene.materials[0].metallic = 0.5F;
    scene.meshes[0].colors = {C4f(1, 1, 1, 1), C4f(0, 1, 1, 1), C4f(1, 0, 1, 1)};
    const SurfaceShading shading(scene);
    const C3f albedo = shading.albedo({.barycentric = V3d(0.5, 0.5, 0)});
    EXPECT_FLOAT_EQ(albedo.x, 0.5F * 0.5F * 0.5F);
    EXPECT_FLOAT_EQ(albedo.y, 0.25F * 1.0F * 0.5F);
    EXPECT_FLOAT_EQ(albedo.z, 0.5F);
}

TEST(SurfaceShading, MetallicTextureIsReadFromBlueWithoutDecoding) {
    Scene scene = triangle_scene();
    scene.images = {two_texels({0, 0, 51, 255}, {0, 0, 51, 255})};
    scene.materials[0].metallic = 1;
    scene.materials[0].metallic_texture = TextureView{};
    EXPECT_NEAR(SurfaceShading(scene).albedo({}).x, 0.8, 1e-6);
}

TEST(SurfaceShading, EmissionIsFactorTimesDecodedTexture) {
    Scene scene = triangle_scene();
    scene.images = {two_texels({188, 255, 0, 255}, {188, 255, 0, 255})};
    scene.materials[0].emission = C3f(10, 20, 30);
    scene.materials[0].emission_texture = TextureView{};
    const C3f emission = SurfaceShading(scene).emission({.width = 0.1});
    EXPECT_NEAR(emission.x, 10 * linear_from_srgb8(188), 1e-3);
    EXPECT_NEAR(emission.y, 20, 1e-3);
    EXPECT_EQ(emission.z, 0.0F);
}

TEST(SurfaceShading, WidthIsMeasuredInTheWorld) {
    Scene scene = triangle_scene(scaled(100, 100, 1));
    scene.images = {two_texels({255, 255, 255, 255}, {0, 0, 0, 255})};
    scene.materials[0].base_color_texture = TextureView{};
    const SurfaceShading shading(scene);
    const V3d white(0.7, 0.25, 0.05);
    EXPECT_NEAR(shading.albedo({.barycentric = white, .width = 1}).x, 1.0, 1e-6);
    EXPECT_NEAR(shading.albedo({.barycentric = white, .width = 400}).x, 0.5, 1e-3);
}

TEST(SurfaceShading, MaskCutsBelowTheCutoffOnly) {
    Scene scene = triangle_scene();
    scene.images = {two_texels({255, 255, 255, 127}, {255, 255, 255, 129})};
    scene.materials[0].base_color_texture = TextureView{.nearest = true};
    const SurfacePlace left{.barycentric = V3d(0.8, 0.1, 0.1)};
    const SurfacePlace right{.barycentric = V3d(0.1, 0.8, 0.1)};
    scene.materials[0].alpha_mode = AlphaMode::mask;
    EXPECT_TRUE(SurfaceShading(scene).is_cut(left));
    EXPECT_FALSE(SurfaceShading(scene).is_cut(right));
    scene.materials[0].alpha_mode = AlphaMode::opaque;
    EXPECT_FALSE(SurfaceShading(scene).is_cut(left));
}

TEST(SurfaceShading, MissingTexcoordsReadTheOrigin) {
    Scene scene = triangle_scene();
    scene.meshes[0].texcoords.clear();
    scene.images = {two_texels({255, 255, 255, 255}, {0, 0, 0, 255})};
    scene.materials[0].base_color_texture = TextureView{.nearest = true};
    EXPECT_NEAR(SurfaceShading(scene).albedo({}).x, 1.0, 1e-6);
}

TEST(SurfaceShading, ShadingNormalFollowsScaleAndMirror) {
    Scene scene = triangle_scene(scaled(2, 1, 1));
    scene.meshes[0].normals.assign(3, V3f(1, 0, 1).normalized());
    const V3d stretched = SurfaceShading(scene).shading_normal({});
    EXPECT_NEAR((stretched - V3d(0.5, 0, 1).normalized()).length(), 0, 1e-7);

    scene.instances[0].world_from_mesh = scaled(-2, 1, 1);
    const V3d mirrored = SurfaceShading(scene).shading_normal({});
    EXPECT_NEAR((mirrored - V3d(-0.5, 0, 1).normalized()).length(), 0, 1e-7);
}

}  // namespace
}  // namespace vmap
