// SPDX-License-Identifier: GPL-3.0-or-later
#include "pov_picture.h"

#include <vmap/surface_shading.h>

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace vmap {
namespace {

using Imath::C3f;
using Imath::C4f;
using Imath::V3d;

/// A chessboard of squares, each with its own material, all under a sun that makes them show their albedo.
class Chart {
public:
    static constexpr int columns = 4;
    static constexpr int cell_pixels = 32;

    /// Adds a square and returns its mesh and material to be changed.
    Mesh& add(const std::string& name) {
        const std::size_t cell = scene.instances.size();
        scene.materials.emplace_back();
        const std::size_t mesh = add_square(scene, scene.materials.size() - 1);
        const std::size_t column = cell % columns;
        const std::size_t row = cell / columns;
        add_instance(scene, mesh,
                     moved({2.0 * static_cast<double>(column) + 1, -2.0 * static_cast<double>(row) - 1, 0}));
        scene.instances.back().name = name;
        return scene.meshes[mesh];
    }
    Material& material() { return scene.materials.back(); }

    std::size_t add_image(int width, int height, bool cut_out = false) {
        Image image{.name = "image", .width = width, .height = height, .rgba = {}};
        std::uint32_t state = 7;
        for (int i = 0; i < width * height; ++i) {
            for (int channel = 0; channel < 4; ++channel) {
                state = state * 1664525U + 1013904223U;
                image.rgba.push_back(static_cast<std::uint8_t>(state >> 24));
            }
            if (!cut_out) image.rgba.back() = 255;
        }
        scene.images.push_back(image);
        return scene.images.size() - 1;
    }

    [[nodiscard]] int rows() const { return static_cast<int>((scene.instances.size() + columns - 1) / columns); }

    void finish() {
        Camera camera;
        camera.orthographic = true;
        camera.half_height = rows();
        camera.world_from_camera = moved({columns, -1.0 * rows(), 5});
        scene.cameras = {camera};
        scene.lights = {sun_from_above()};
    }

    [[nodiscard]] PovConfig config() const {
        PovConfig config;
        config.width = columns * cell_pixels;
        config.height = rows() * cell_pixels;
        return config;
    }

    /// The place that a pixel of a cell shows; places of the upper left triangle only.
    [[nodiscard]] static SurfacePlace place_of(std::size_t cell, int x, int y) {
        const double right = (x + 0.5) / cell_pixels, down = (y + 0.5) / cell_pixels;
        // Vertices: lower left, upper right, upper left.
        return {.instance = cell, .triangle = 1, .barycentric = {down, right, 1 - down - right}};
    }

    /// Largest difference between the picture and expected(place) in a cell, away from the diagonal.
    template <class Expected>
    [[nodiscard]] static double worst(const Picture& picture, std::size_t cell, const Expected& expected) {
        double worst = 0;
        for (int y = 0; y < cell_pixels; ++y) {
            for (int x = 0; x + y < cell_pixels - 2; ++x) {
                const C3f& shown = picture.at(static_cast<int>(cell) % columns * cell_pixels + x,
                                              static_cast<int>(cell) / columns * cell_pixels + y);
                const C3f wanted = expected(place_of(cell, x, y));
                for (int channel = 0; channel < 3; ++channel)
                    worst = std::max(worst, static_cast<double>(std::abs(shown[channel] - wanted[channel])) /
                                                (0.1 + wanted[channel]));
            }
        }
        return worst;
    }

    Scene scene;
};

class PovMaterials : public PovRayTest {
protected:
    /// Each cell shows emission + albedo as SurfaceShading has them.
    void expect_shown(const Chart& chart, double tolerance) const {
        const Picture picture = render(chart.scene, chart.config());
        const SurfaceShading shading(chart.scene);
        for (std::size_t cell = 0; cell < chart.scene.instances.size(); ++cell) {
            const double worst = Chart::worst(picture, cell, [&](const SurfacePlace& place) {
                if (shading.is_cut(place)) return C3f(0);
                return shading.albedo(place) + shading.emission(place);
            });
            EXPECT_LT(worst, tolerance) << chart.scene.instances[cell].name;
        }
    }
};

TEST_F(PovMaterials, ColoursAndImagesShowTheAlbedo) {
    Chart chart;
    const std::size_t image = chart.add_image(5, 4);
    const auto texture = [&](WrapMode wrap) {
        TextureView view;
        view.image = image;
        view.wrap_u = view.wrap_v = wrap;
        return view;
    };
    const auto stretch = [](Mesh& mesh, float begin, float end) {
        for (auto& texcoord : mesh.texcoords[0]) texcoord = texcoord * (end - begin) + Imath::V2f(begin);
    };

    chart.add("plain");
    chart.material().base_color = {0.2F, 0.4F, 0.8F, 1};
    chart.add("half metal");
    chart.material().metallic = 0.5F;
    chart.add("metal with an image");
    chart.material().metallic = 1;
    chart.material().base_color_texture = texture(WrapMode::repeat);
    chart.add("image");
    chart.material().base_color_texture = texture(WrapMode::repeat);

    stretch(chart.add("image repeated"), -1.25F, 2);
    chart.material().base_color_texture = texture(WrapMode::repeat);
    stretch(chart.add("image mirrored"), -1.25F, 2);
    chart.material().base_color_texture = texture(WrapMode::mirrored_repeat);
    chart.add("image clamped within");
    chart.material().base_color_texture = texture(WrapMode::clamp_to_edge);
    chart.add("image times colour");
    chart.material().base_color_texture = texture(WrapMode::repeat);
    chart.material().base_color = {0.3F, 0.6F, 0.9F, 1};

    TextureView transformed = texture(WrapMode::repeat);
    transformed.image_from_texcoord = {{{0.5, 0.3, 0.1}, {-0.4, 0.8, 0.2}}};
    chart.add("image transformed");
    chart.material().base_color_texture = transformed;
    chart.add("vertex colours").colors = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0.5F, 0.5F, 0.1F, 1}, {0, 0, 1, 1}};
    chart.material().base_color = {0.5F, 1, 1, 1};
    chart.add("one vertex colour").colors = std::vector<C4f>(4, C4f(0.5F, 0.25F, 0.75F, 1));
    chart.material().base_color_texture = texture(WrapMode::repeat);
    chart.finish();
    expect_shown(chart, 0.02);
}

/// Not exact between the texels of either image: these are noise, the worst case.
TEST_F(PovMaterials, ProductOfImagesIsWrittenFinely) {
    Chart chart;
    TextureView view;
    view.image = chart.add_image(5, 4);
    chart.add("metal by an image of another size");
    chart.material().base_color_texture = view;
    chart.material().metallic = 0.8F;
    view.image = chart.add_image(7, 3);
    chart.material().metallic_texture = view;
    chart.finish();
    expect_shown(chart, 0.2);
}

TEST_F(PovMaterials, NearestTexelsStaySharp) {
    Chart chart;
    TextureView view;
    view.image = chart.add_image(4, 4);
    view.nearest = true;
    chart.add("nearest");
    chart.material().base_color_texture = view;
    chart.finish();
    expect_shown(chart, 0.02);
}

/// Colours on tiles: as fine as the image, not exact at the hypotenuse.
TEST_F(PovMaterials, WhatPovRayCannotMultiplyIsTiled) {
    Chart chart;
    TextureView view;
    view.image = chart.add_image(4, 4);
    TextureView clamped = view;
    clamped.wrap_u = clamped.wrap_v = WrapMode::clamp_to_edge;

    chart.add("vertex colours times image").colors = {
        {1, 0.2F, 0.1F, 1}, {0.3F, 1, 1, 1}, {1, 1, 0, 1}, {0.5F, 0.5F, 1, 1}};
    chart.material().base_color_texture = view;
    for (auto& texcoord : chart.add("image clamped beyond").texcoords[0]) texcoord = texcoord * 2.0F - Imath::V2f(0.5F);
    chart.material().base_color_texture = clamped;
    Mesh& two_sets = chart.add("two sets of coordinates");
    two_sets.texcoords.push_back({{0, 0}, {0, 1}, {1, 1}, {1, 0}});
    chart.material().base_color_texture = view;
    chart.material().emission = {1, 2, 3};
    TextureView other_set = view;
    other_set.texcoord_set = 1;
    chart.material().emission_texture = other_set;
    chart.add("no coordinates").texcoords.clear();
    chart.material().base_color_texture = view;
    chart.finish();
    for (auto& material : chart.scene.materials) material.base_color = {0.7F, 0.8F, 0.9F, 1};
    expect_shown(chart, 0.15);
}

TEST_F(PovMaterials, EmissionAddsToTheReflection) {
    Chart chart;
    TextureView view;
    view.image = chart.add_image(5, 4);
    TextureView other = view;
    other.image = chart.add_image(7, 3);

    chart.add("emission over albedo");
    chart.material().base_color = {0.2F, 0.4F, 0.8F, 1};
    chart.material().emission = {3, 2, 1};
    chart.add("emission over black");
    chart.material().base_color = {0, 0, 0, 1};
    chart.material().emission = {3, 0, 100};
    chart.add("emission where the albedo is zero");
    chart.material().base_color = {0.5F, 0, 0.5F, 1};
    chart.material().emission = {0, 2, 1};
    chart.add("emission over an image");
    chart.material().base_color_texture = view;
    chart.material().emission = {0.5F, 2, 1};

    chart.add("emission by an image");
    chart.material().base_color = {0.2F, 0.4F, 0.8F, 1};
    chart.material().emission = {5, 5, 2};
    chart.material().emission_texture = view;
    chart.add("two images");
    chart.material().base_color_texture = view;
    chart.material().emission = {5, 5, 2};
    chart.material().emission_texture = other;
    chart.add("vertex colours").colors = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0.5F, 0.5F, 0.1F, 1}, {0, 0, 1, 1}};
    chart.material().emission = {1, 2, 3};
    chart.finish();
    expect_shown(chart, 0.02);
}

/// A cut-out shows the square behind it, and lets the sun through.
TEST_F(PovMaterials, MaskCutsTheSurfaceAway) {
    Scene scene = square_under_sun();
    scene.images.push_back({.name = "", .width = 2, .height = 1, .rgba = {255, 0, 0, 0, 0, 255, 0, 255}});
    scene.materials.resize(3);
    scene.materials[1].alpha_mode = AlphaMode::mask;
    scene.materials[1].base_color_texture = TextureView();
    scene.materials[1].emission = {0, 0, 2};
    scene.materials[2].alpha_mode = AlphaMode::mask;
    scene.materials[2].base_color.a = 0.25F;
    add_instance(scene, add_square(scene, 1), moved({0, 0, 1}));
    add_instance(scene, add_square(scene, 2), moved({0, 0, 2}));
    PovConfig config;
    config.width = config.height = 40;
    const Picture picture = render(scene, config);
    for (int y = 0; y < 40; ++y) {
        const C3f& left = picture.at(12, y);
        const C3f& right = picture.at(28, y);
        ASSERT_NEAR(left.x, 1, 0.001);
        ASSERT_NEAR(left.z, 1, 0.001);
        ASSERT_NEAR(right.x, 0, 0.001);
        ASSERT_NEAR(right.y, 1, 0.001);
        ASSERT_NEAR(right.z, 2, 0.002);
        ASSERT_GT(picture.at(18, y).x, 0.9);  // cut where the interpolated alpha falls below one half: in the middle
        ASSERT_LT(picture.at(21, y).x, 0.3);
    }
}

/// Seen from behind: single-sided ones are black, mirrored ones turn with their mesh.
TEST_F(PovMaterials, BacksOfSingleSidedSurfacesAreBlackAndBlock) {
    Scene scene;
    scene.materials.resize(2);
    scene.materials[0].emission = {2, 2, 2};
    scene.materials[1].emission = {2, 2, 2};
    scene.materials[1].double_sided = true;
    const std::size_t single = add_square(scene, 0), both = add_square(scene, 1);
    const V3d half(0.5, 0.5, 0.5);
    add_instance(scene, single, scaled(half) * moved({-0.5, 0.5, 0}));               // front
    add_instance(scene, single, scaled({-0.5, 0.5, -0.5}) * moved({0.5, 0.5, 0}));   // turned around: back
    add_instance(scene, single, scaled({-0.5, 0.5, 0.5}) * moved({-0.5, -0.5, 0}));  // mirrored: front
    add_instance(scene, both, scaled({-0.5, 0.5, -0.5}) * moved({0.5, -0.5, 0}));    // double: back
    add_instance(scene, both, scaled({2, 2, 2}) * moved({0, 0, -1}));                // behind all of them
    scene.cameras = {camera_over_square()};
    PovConfig config;
    config.width = config.height = 40;
    const Picture picture = render(scene, config);
    EXPECT_NEAR(picture.at(10, 10).x, 2, 0.002);
    EXPECT_EQ(picture.at(30, 10).x, 0);
    EXPECT_NEAR(picture.at(10, 30).x, 2, 0.002);
    EXPECT_NEAR(picture.at(30, 30).x, 2, 0.002);

    for (Mesh& mesh : scene.meshes) mesh.colors = {{1, 1, 1, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}, {1, 1, 0, 1}};
    const Picture colored = render(scene, config);
    EXPECT_NEAR(colored.at(10, 10).x, 2, 0.002);
    EXPECT_EQ(colored.at(30, 10).x, 0);
    EXPECT_NEAR(colored.at(30, 30).x, 2, 0.002);
}

TEST_F(PovMaterials, MirroredInstanceIsLitInFront) {
    Scene scene = square_under_sun();
    scene.instances[0].world_from_mesh = scaled({-1, 1, 1});
    PovConfig config;
    config.width = config.height = 8;
    EXPECT_NEAR(render(scene, config).at(4, 4).x, 1, 0.001);
    scene.instances[0].world_from_mesh = scaled({1, 1, -1});  // its front looks away from the camera
    EXPECT_EQ(render(scene, config).at(4, 4).x, 0);
}

TEST_F(PovMaterials, InstancesShareOneDeclaration) {
    Scene scene = square_under_sun();
    scene.instances.clear();
    for (int i = 0; i < 100; ++i) add_instance(scene, 0, moved({0, 0, -i * 0.01}));
    PovConfig config;
    config.width = config.height = 8;
    EXPECT_NEAR(render(scene, config).at(4, 4).x, 1, 0.001);
    const std::string text = content("scene.pov");
    std::size_t count = 0;
    for (std::size_t at = text.find("mesh2"); at != std::string::npos; at = text.find("mesh2", at + 1)) ++count;
    EXPECT_EQ(count, 1U);
}

TEST_F(PovMaterials, ShadingNormalsBendTheLightOnRequest) {
    Scene scene = square_under_sun();
    // From (-1, 0, 1) on the left to (1, 0, 1) on the right.
    scene.meshes[0].normals = {{-1, 0, 1}, {1, 0, 1}, {1, 0, 1}, {-1, 0, 1}};
    for (Imath::V3f& normal : scene.meshes[0].normals) normal.normalize();
    PovConfig config;
    config.width = config.height = 8;
    EXPECT_NEAR(render(scene, config).at(1, 4).x, 1, 0.001);
    config.shading_normals = true;
    const Picture picture = render(scene, config);
    for (int x = 0; x < 8; ++x) {
        const double place = (x + 0.5) / 4 - 1;
        EXPECT_NEAR(picture.at(x, 4).x, 1 / std::sqrt(1 + place * place), 0.001);
    }
}

}  // namespace
}  // namespace vmap
