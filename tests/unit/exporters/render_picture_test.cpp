// SPDX-License-Identifier: GPL-3.0-or-later
#include <vmap/error.h>
#include <vmap/exporters/render_picture.h>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "../importers/test_scenes.h"
#include "picture_scenes.h"

namespace vmap {
namespace {

using Imath::C3f;
using Imath::M44d;
using Imath::V2d;
using Imath::V3d;
using test::lit_points;
using test::looking;

/// Where surfaces come from: the triangles of the scene, or the points alone.
class PictureOf : public testing::TestWithParam<bool> {
protected:
    [[nodiscard]] static const Scene* source(const Scene& scene) { return GetParam() ? &scene : nullptr; }
};
INSTANTIATE_TEST_SUITE_P(Surface, PictureOf, testing::Bool(), [](const testing::TestParamInfo<bool>& from) {
    return std::string(from.param ? "SceneAndPoints" : "PointsAlone");
});

float alpha_at(const Picture& picture, int x, int y) {
    return picture
        .alpha[static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) + static_cast<std::size_t>(x)];
}

C3f constant_light(const V3d&, const V3d&) {
    return C3f(1);
}

M44d moved(const V3d& by) {
    return M44d().setTranslation(by);
}

/// A closed room from 0 to size, fronts inwards.
Mesh room_mesh(const Imath::V3f& size) {
    Mesh mesh = test::box_mesh(size);
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) std::swap(mesh.indices[3 * t], mesh.indices[3 * t + 1]);
    return mesh;
}

Material grey(float albedo) {
    Material material;
    material.base_color = {albedo, albedo, albedo, 1};
    return material;
}

constexpr RenderConfig irradiance_picture{.width = 128, .height = 128, .content = PictureContent::irradiance};

TEST_P(PictureOf, SilhouetteOfASphereIsItsOutlineWithinAPixel) {
    const Scene scene = test::scene_of(test::sphere_mesh(256, 128), grey(0.5F));
    const LitCloud cloud = lit_points(scene, 0.03, constant_light);
    constexpr double distance = 4;
    const Camera camera = looking({0, 0, distance}, V3d(0), 0.7);
    constexpr int size = 200;
    const Picture picture = render_picture(cloud, camera, {.width = size, .height = size}, source(scene));

    // The outline of a unit sphere is a circle about the picture's middle.
    const double scale = size / 2.0 / std::tan(0.35);
    const double radius = scale / std::sqrt(distance * distance - 1);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const double from_middle = V2d(x + 0.5 - size / 2.0, y + 0.5 - size / 2.0).length();
            if (from_middle < radius - 1.2) {
                EXPECT_EQ(alpha_at(picture, x, y), 1) << x << ", " << y;
            }
            if (from_middle > radius + 1.2) {
                EXPECT_EQ(alpha_at(picture, x, y), 0) << x << ", " << y;
            }
        }
}

TEST_P(PictureOf, EvenLightOnASphereIsEven) {
    const Scene scene = test::scene_of(test::sphere_mesh(64, 32), grey(0.5F));
    const LitCloud cloud = lit_points(scene, 0.05, constant_light);
    const Picture picture = render_picture(cloud, looking({1, 2, 3}, V3d(0)), irradiance_picture, source(scene));
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        ASSERT_NEAR(picture.pixels[i].x, picture.alpha[i], 1e-4) << "pixel " << i;
}

TEST_P(PictureOf, LightThatGrowsLinearlyOverAWallIsReproducedUpToItsBorder) {
    const Scene scene = test::scene_of(test::grid_mesh(2, 1, 1, 1), grey(0.5F));
    const auto field = [](const V3d& p, const V3d&) {
        return C3f(static_cast<float>(1 + 2 * p.x + 3 * p.y), static_cast<float>(5 - p.x), 4);
    };
    const LitCloud cloud = lit_points(scene, 0.03, field);
    Camera camera = looking({1, 0.5, 5}, {1, 0.5, 0});
    camera.orthographic = true;
    camera.half_height = 1;
    const RenderConfig config{.width = 200, .height = 200, .content = PictureContent::irradiance};
    const Picture picture = render_picture(cloud, camera, config, source(scene));
    int seen = 0;
    for (int y = 0; y < config.height; ++y)
        for (int x = 0; x < config.width; ++x) {
            if (alpha_at(picture, x, y) < 1) continue;
            const C3f expected = field({(x + 0.5) / 100, 0.5 - (y + 0.5 - 100) / 100, 0}, {});
            for (int k = 0; k < 3; ++k)
                ASSERT_NEAR(picture.at(x, y)[k] / expected[k], 1, 1e-3) << x << ", " << y << ", channel " << k;
            ++seen;
        }
    EXPECT_NEAR(seen, 200 * 100, 400);
}

TEST_P(PictureOf, CornersDoNotBleed) {
    // A floor with E = 1 and a wall with E = 0 meet in the middle of the picture.
    Scene scene;
    test::add(scene, test::grid_mesh(2, 1, 1, 1), grey(0.5F));
    test::add(scene, test::grid_mesh(2, 1, 1, 1), grey(0.5F), M44d(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 1));
    const LitCloud cloud =
        lit_points(scene, 0.05, [](const V3d&, const V3d& n) { return C3f(n.z > 0.5 ? 1.0F : 0.0F); });
    Camera camera = looking({1, -1, 2}, {1, 1, 0});
    camera.orthographic = true;
    camera.half_height = 0.4;
    const Picture picture = render_picture(cloud, camera, irradiance_picture, source(scene));
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 128; ++x) {
            if (std::abs(y + 0.5 - 64) < 1.5) continue;
            ASSERT_NEAR(picture.at(x, y).x, y < 64 ? 0 : 1, 1e-4) << x << ", " << y;
        }
}

TEST_P(PictureOf, ThinWallsDoNotLeak) {
    // Two sheets a thousandth apart, back to back, one lit.
    Scene scene;
    test::add(scene, test::grid_mesh(1, 1, 1, 1), grey(0.5F), moved({0, 0, 0.001}));
    test::add(scene, test::grid_mesh(1, 1, 1, 1), grey(0.5F), M44d(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 1, 0, 0, 1));
    const LitCloud cloud = lit_points(scene, 0.05, [](const V3d&, const V3d& n) { return C3f(n.z > 0 ? 1.0F : 0.0F); });
    for (const double side : {1.0, -1.0}) {
        const Picture picture =
            render_picture(cloud, looking({0.5, 0.5, 3 * side}, {0.5, 0.5, 0}), irradiance_picture, source(scene));
        EXPECT_NEAR(picture.at(64, 64).x, side > 0 ? 1 : 0, 1e-5);
        // The border of what is made from points is good to a fraction of their spacing, of 2.6 pixels here.
        for (int y = 0; y < 128; ++y)
            for (int x = 0; x < 128; ++x) {
                const double inside = 64 * 0.5 / (3 * std::tan(0.4)) - std::max(std::abs(x - 63.5), std::abs(y - 63.5));
                if (GetParam() || inside > 2.6) {
                    ASSERT_NEAR(picture.at(x, y).x, side > 0 ? alpha_at(picture, x, y) : 0, 1e-4) << x << ", " << y;
                }
            }
    }
}

TEST_P(PictureOf, ARoomHasNoHoles) {
    Scene scene = test::scene_of(room_mesh({1, 1, 1}), grey(0.5F));
    test::add(scene, test::sphere_mesh(48, 24), grey(0.5F),
              M44d(0.3, 0, 0, 0, 0, 0.3, 0, 0, 0, 0, 0.3, 0, 0.5, 0.3, 0.5, 1));
    const LitCloud cloud = lit_points(scene, 0.03, constant_light);
    for (const V3d& from : {V3d(0.1, 0.9, 0.9), V3d(0.9, 0.8, 0.1), V3d(0.5, 0.95, 0.5)}) {
        const Picture picture =
            render_picture(cloud, looking(from, {0.45, 0.3, 0.5}, 1.5), irradiance_picture, source(scene));
        for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
            ASSERT_EQ(picture.alpha[i], 1) << "pixel " << i;
            ASSERT_NEAR(picture.pixels[i].x, 1, 1e-3) << "pixel " << i;
        }
    }
}

TEST_P(PictureOf, BacksAreBlackAndHideWhatLiesBehind) {
    Scene scene;
    test::add(scene, test::grid_mesh(1, 1, 1, 1), grey(0.5F));
    test::add(scene, test::grid_mesh(1, 1, 1, 1), grey(0.5F), M44d(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 1, 0, 1, 1));
    const LitCloud cloud = lit_points(scene, 0.05, constant_light);
    const Picture picture = render_picture(cloud, looking({0.5, 0.5, 4}, {0.5, 0.5, 0}), {}, source(scene));
    EXPECT_EQ(picture.at(256, 256), C3f(0));
    EXPECT_EQ(alpha_at(picture, 256, 256), 1);
    EXPECT_EQ(alpha_at(picture, 2, 2), 0);
    EXPECT_EQ(picture.at(2, 2), C3f(0));
}

TEST_P(PictureOf, BothSidesOfADoubleSidedSheetShowTheirOwnLight) {
    Material material = grey(0.5F);
    material.double_sided = true;
    const Scene scene = test::scene_of(test::grid_mesh(1, 1, 1, 1), material);
    const LitCloud cloud =
        lit_points(scene, 0.05, [](const V3d&, const V3d& n) { return n.z > 0 ? C3f(3, 2, 1) : C3f(1, 5, 7); });
    for (const double side : {1.0, -1.0}) {
        const Picture picture =
            render_picture(cloud, looking({0.5, 0.5, 3 * side}, {0.5, 0.5, 0}), irradiance_picture, source(scene));
        EXPECT_LT((picture.at(64, 64) - (side > 0 ? C3f(3, 2, 1) : C3f(1, 5, 7))).length(), 1e-4) << side;
    }
}

TEST_P(PictureOf, RadianceIsEmissionPlusReflectedLight) {
    Material lamp = grey(0.25F);
    lamp.emission = {7, 8, 9};
    Scene scene;
    test::add(scene, test::grid_mesh(1, 1, 1, 1), grey(0.8F));
    test::add(scene, test::grid_mesh(1, 1, 1, 1), lamp, moved({1.5, 0, 0}));
    const LitCloud cloud = lit_points(scene, 0.05, [](const V3d&, const V3d&) { return C3f(1, 2, 3); });
    const Camera camera = looking({1.25, 0.5, 4}, {1.25, 0.5, 0});
    const Picture picture = render_picture(cloud, camera, {.width = 200, .height = 100}, source(scene));
    const float scale = 50 / static_cast<float>(std::tan(0.4)) / 4;
    const auto column = [&](float x) { return static_cast<int>(100 + (x - 1.25F) * scale); };
    const C3f diffuse = C3f(1, 2, 3) * 0.8F / std::numbers::pi_v<float>;
    const C3f glowing = C3f(7, 8, 9) + C3f(1, 2, 3) * 0.25F / std::numbers::pi_v<float>;
    EXPECT_LT((picture.at(column(0.5F), 50) - diffuse).length(), 1e-4);
    EXPECT_LT((picture.at(column(2), 50) - glowing).length(), 1e-4);
}

TEST_P(PictureOf, ALampJustBelowACeilingKeepsItsOwnLight) {
    Material lamp = grey(0.5F);
    lamp.emission = {1, 1, 1};
    Scene scene;
    test::add(scene, test::grid_mesh(2, 2, 1, 1), grey(0.5F));
    test::add(scene, test::grid_mesh(0.5F, 0.5F, 1, 1), lamp, moved({0.75, 0.75, 0.005}));
    const LitCloud cloud =
        lit_points(scene, 0.05, [](const V3d& p, const V3d&) { return C3f(p.z > 0.001 ? 0.0F : 1.0F); });
    Camera camera = looking({1, 1, 4}, {1, 1, 0});
    camera.orthographic = true;
    camera.half_height = 0.9;
    const Picture picture = render_picture(cloud, camera, irradiance_picture, source(scene));
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 128; ++x) {
            const double reach = std::max(std::abs(x + 0.5 - 64), std::abs(y + 0.5 - 64)) - 0.25 / 0.9 * 64;
            if (std::abs(reach) < 1.5) continue;
            ASSERT_NEAR(picture.at(x, y).x, reach < 0 ? 0 : 1, 1e-4) << x << ", " << y;
        }
}

TEST_P(PictureOf, TheDarkUnderABoxDoesNotShowAroundIt) {
    Scene scene;
    test::add(scene, test::grid_mesh(2, 2, 1, 1), grey(0.5F));
    test::add(scene, test::box_mesh({0.5F, 0.5F, 0.5F}), grey(0.5F), moved({0.75, 0.75, 0}));
    const LitCloud cloud = lit_points(scene, 0.05, [](const V3d& p, const V3d&) {
        const bool under = p.z == 0 && std::abs(p.x - 1) < 0.25 && std::abs(p.y - 1) < 0.25;
        return C3f(under ? 0.0F : 1.0F);
    });
    for (const V3d& from : {V3d(1, -3, 3), V3d(4, 4, 2), V3d(1, 1, 5)}) {
        const Picture picture = render_picture(cloud, looking(from, {1, 1, 0}), irradiance_picture, source(scene));
        // Samples that hit the very edge between box and floor may see either.
        std::size_t darkened = 0;
        for (std::size_t i = 0; i < picture.pixels.size(); ++i)
            if (std::abs(picture.pixels[i].x - picture.alpha[i]) > 1e-3F) ++darkened;
        EXPECT_LE(darkened, 10U);
    }
}

TEST_P(PictureOf, SameAtAnyNumberOfThreads) {
    Scene scene = test::scene_of(room_mesh({1, 1, 1}), grey(0.5F));
    test::add(scene, test::sphere_mesh(32, 16), grey(0.7F),
              M44d(0.3, 0, 0, 0, 0, 0.3, 0, 0, 0, 0, 0.3, 0, 0.5, 0.3, 0.5, 1));
    const LitCloud cloud = lit_points(
        scene, 0.02, [](const V3d& p, const V3d& n) { return C3f(static_cast<float>(1 + std::sin(9 * p.x) + n.y)); });
    const Camera camera = looking({0.1, 0.9, 0.9}, {0.5, 0.3, 0.5}, 1.5);
    std::vector<Picture> pictures;
    for (const std::size_t threads : {1, 2, 8}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        pictures.push_back(render_picture(cloud, camera, {.width = 150, .height = 100}, source(scene)));
    }
    for (const Picture& picture : pictures) {
        EXPECT_EQ(picture.pixels, pictures[0].pixels);
        EXPECT_EQ(picture.alpha, pictures[0].alpha);
    }
}

TEST_P(PictureOf, FarFromTheOriginIsAsSharp) {
    const V3d far_away(4.5e6, 0, -3.2e6);
    const Scene here = test::scene_of(test::grid_mesh(1, 1, 1, 1), grey(0.5F));
    const Scene there = test::scene_of(test::grid_mesh(1, 1, 1, 1), grey(0.5F), moved(far_away));
    const auto field = [](const V3d& p, const V3d&) { return C3f(static_cast<float>(1 + p.x)); };
    const LitCloud cloud = lit_points(here, 0.02, field);
    LitCloud far_cloud = cloud;
    far_cloud.points.origin = far_away;
    const V3d from(0.4, 0.6, 2);
    const V3d to(0.5, 0.5, 0);
    const Picture near_picture = render_picture(cloud, looking(from, to), irradiance_picture, source(here));
    const Picture far_picture =
        render_picture(far_cloud, looking(from + far_away, to + far_away), irradiance_picture, source(there));
    double difference = 0;
    for (std::size_t i = 0; i < near_picture.pixels.size(); ++i)
        difference =
            std::max(difference, std::abs(static_cast<double>(near_picture.pixels[i].x - far_picture.pixels[i].x)));
    EXPECT_LT(difference, 0.13);  // a sixteenth of a pixel at the border
}

TEST_P(PictureOf, PaintShowsTheColourOfTheNearestPoint) {
    const Scene scene = test::scene_of(test::grid_mesh(1, 1, 1, 1), grey(0.5F));
    const LitCloud cloud = lit_points(scene, 0.1, constant_light);
    std::vector<C3f> paint(cloud.points.size());
    for (std::size_t i = 0; i < paint.size(); ++i) paint[i].x = static_cast<float>(i);
    Camera camera = looking({0.5, 0.5, 3}, {0.5, 0.5, 0});
    camera.orthographic = true;
    camera.half_height = 0.45;
    const RenderConfig config{.width = 90, .height = 90, .content = PictureContent::paint, .paint = paint};
    const Picture picture = render_picture(cloud, camera, config, source(scene));
    for (int y = 0; y < 90; ++y)
        for (int x = 0; x < 90; ++x) {
            const Imath::V3f place(0.05F + (static_cast<float>(x) + 0.5F) / 100,
                                   0.95F - (static_cast<float>(y) + 0.5F) / 100, 0);
            float nearest = std::numeric_limits<float>::max();
            for (const Imath::V3f& p : cloud.points.positions) nearest = std::min(nearest, (p - place).length());
            const auto shown = static_cast<std::size_t>(picture.at(x, y).x);
            EXPECT_NEAR((cloud.points.positions[shown] - place).length(), nearest, 1e-4) << x << ", " << y;
        }
}

/// Squares of one texel, black and white.
Image checkerboard(int size) {
    Image image{.name = "checkerboard", .width = size, .height = size, .rgba = {}};
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const auto value = static_cast<std::uint8_t>((x + y) % 2 != 0 ? 255 : 0);
            image.rgba.insert(image.rgba.end(), {value, value, value, 255});
        }
    return image;
}

TEST(RenderPicture, TexturesShowAtTheResolutionOfThePicture) {
    Scene scene = test::scene_of(test::grid_mesh(1, 1, 1, 1));
    scene.images = {checkerboard(64)};
    scene.materials[0].base_color_texture = TextureView{.nearest = true};
    // Points far coarser than the squares.
    const LitCloud cloud =
        lit_points(scene, 0.1, [](const V3d&, const V3d&) { return C3f(std::numbers::pi_v<float>); });
    Camera camera = looking({0.5, 0.5, 3}, {0.5, 0.5, 0});
    camera.orthographic = true;
    camera.half_height = 0.5;
    const Picture picture = render_picture(cloud, camera, {.width = 256, .height = 256}, &scene);
    for (int y = 0; y < 256; ++y)
        for (int x = 0; x < 256; ++x) {
            const int square = x / 4 + (255 - y) / 4;
            ASSERT_NEAR(picture.at(x, y).x, square % 2 != 0 ? 1 : 0, 0.02) << x << ", " << y;
        }
}

TEST(RenderPicture, TexturesTurnGreyWhereTheyAreTooFine) {
    Scene scene = test::scene_of(test::grid_mesh(1, 1, 1, 1));
    scene.images = {checkerboard(512)};
    scene.materials[0].base_color_texture = TextureView{};
    const LitCloud cloud =
        lit_points(scene, 0.05, [](const V3d&, const V3d&) { return C3f(std::numbers::pi_v<float>); });
    Camera camera = looking({0.5, 0.5, 3}, {0.5, 0.5, 0});
    camera.orthographic = true;
    camera.half_height = 0.4;
    const Picture picture = render_picture(cloud, camera, {.width = 64, .height = 64}, &scene);
    for (const C3f& pixel : picture.pixels) ASSERT_NEAR(pixel.x, 0.5, 0.03);
}

TEST(RenderPicture, AlphaMasksCutHoles) {
    Scene scene = test::scene_of(test::grid_mesh(1, 1, 1, 1));
    Image image{.name = "half", .width = 2, .height = 1, .rgba = {255, 255, 255, 255, 255, 255, 255, 0}};
    scene.images = {image};
    scene.materials[0].base_color_texture = TextureView{.nearest = true};
    scene.materials[0].alpha_mode = AlphaMode::mask;
    const LitCloud cloud = lit_points(scene, 0.05, constant_light);
    Camera camera = looking({0.5, 0.5, 3}, {0.5, 0.5, 0});
    camera.orthographic = true;
    camera.half_height = 0.4;
    const Picture picture = render_picture(cloud, camera, {.width = 64, .height = 64}, &scene);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) ASSERT_EQ(alpha_at(picture, x, y), x < 32 ? 1 : 0) << x << ", " << y;
}

TEST(RenderPicture, MirroredInstancesKeepTheirFrontsAndTextures) {
    Scene scene = test::scene_of(test::grid_mesh(1, 1, 1, 1));
    Image image{.name = "left", .width = 2, .height = 1, .rgba = {255, 255, 255, 255, 0, 0, 0, 255}};
    scene.images = {image};
    scene.materials[0].base_color_texture = TextureView{.nearest = true};
    scene.instances[0].world_from_mesh = M44d(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1);
    const LitCloud cloud = lit_points(scene, 0.05, constant_light);
    Camera camera = looking({0.5, 0.5, 3}, {0.5, 0.5, 0});
    camera.orthographic = true;
    camera.half_height = 0.4;
    const RenderConfig config{.width = 64, .height = 64, .content = PictureContent::albedo};
    const Picture picture = render_picture(cloud, camera, config, &scene);
    EXPECT_NEAR(picture.at(10, 32).x, 0, 1e-3);
    EXPECT_NEAR(picture.at(54, 32).x, 1, 1e-3);
}

TEST(RenderPicture, NormalsPointToTheCamera) {
    const Scene scene = test::scene_of(test::grid_mesh(1, 1, 1, 1));
    const LitCloud cloud = lit_points(scene, 0.1, constant_light);
    const RenderConfig config{.width = 16, .height = 16, .content = PictureContent::normals};
    const Picture front = render_picture(cloud, looking({0.5, 0.5, 2}, {0.5, 0.5, 0}), config, &scene);
    const Picture back = render_picture(cloud, looking({0.5, 0.5, -2}, {0.5, 0.5, 0}), config, &scene);
    EXPECT_LT((front.at(8, 8) - C3f(0.5F, 0.5F, 1)).length(), 1e-5);
    EXPECT_LT((back.at(8, 8) - C3f(0.5F, 0.5F, 0)).length(), 1e-5);
}

TEST(RenderPicture, NothingIsAnEmptyPicture) {
    for (const bool with_scene : {false, true}) {
        const Scene scene;
        const Picture picture =
            render_picture({}, looking({0, 0, 1}, V3d(0)), {.width = 3, .height = 2}, with_scene ? &scene : nullptr);
        EXPECT_EQ(picture.pixels, std::vector<C3f>(6, C3f(0)));
        EXPECT_EQ(picture.alpha, std::vector<float>(6, 0));
    }
}

TEST(RenderPicture, RefusesWhatMakesNoPicture) {
    const Scene scene = test::scene_of(test::grid_mesh(1, 1, 1, 1));
    const LitCloud cloud = lit_points(scene, 0.1, constant_light);
    const Camera camera = looking({0.5, 0.5, 2}, {0.5, 0.5, 0});
    EXPECT_THROW((void)render_picture(cloud, camera, {.width = 0}), UsageError);
    EXPECT_THROW((void)render_picture(cloud, camera, {.height = max_picture_side + 1}), UsageError);
    EXPECT_THROW((void)render_picture(cloud, camera, {.content = PictureContent::paint}), UsageError);

    Camera blind = camera;
    blind.vertical_fov = 0;
    EXPECT_THROW((void)render_picture(cloud, blind), UsageError);
    blind.orthographic = true;
    blind.half_height = -1;
    EXPECT_THROW((void)render_picture(cloud, blind), UsageError);
    Camera lost = camera;
    lost.world_from_camera[3][0] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW((void)render_picture(cloud, lost), UsageError);
    Camera flat = camera;
    flat.world_from_camera = M44d(0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1);
    EXPECT_THROW((void)render_picture(cloud, flat), UsageError);

    LitCloud dark = cloud;
    dark.irradiance.clear();
    EXPECT_THROW((void)render_picture(dark, camera), UsageError);
    EXPECT_NO_THROW((void)render_picture(dark, camera, {.width = 8, .height = 8, .content = PictureContent::albedo}));
}

TEST(RenderPicture, RefusesASceneThatThePointsAreNotFrom) {
    const Scene scene = test::scene_of(test::grid_mesh(1, 1, 2, 2), grey(0.5F));
    const LitCloud cloud = lit_points(scene, 0.1, constant_light);
    const Camera camera = looking({0.5, 0.5, 2}, {0.5, 0.5, 0});
    const Scene smaller = test::scene_of(test::grid_mesh(1, 1, 1, 1), grey(0.5F));
    const Scene elsewhere = test::scene_of(test::grid_mesh(1, 1, 2, 2), grey(0.5F), moved({0, 0, 1}));
    EXPECT_NO_THROW((void)render_picture(cloud, camera, {.width = 8, .height = 8}, &scene));
    EXPECT_THROW((void)render_picture(cloud, camera, {.width = 8, .height = 8}, &smaller), UsageError);
    EXPECT_THROW((void)render_picture(cloud, camera, {.width = 8, .height = 8}, &elsewhere), UsageError);
}

}  // namespace
}  // namespace vmap
