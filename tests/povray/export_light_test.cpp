// SPDX-License-Identifier: GPL-3.0-or-later
#include "pov_picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace vmap {
namespace {

using Imath::C3f;
using Imath::M44d;
using Imath::V3d;

/// POV-Ray's picture is in half floats, cut off after 11 bits.
constexpr double half_float = 0x1p-10;

class PovLight : public PovRayTest {};

/// A floor (y = 0, facing up) of 20 x 20 units, white, and a camera that looks at it askew.
Scene floor_scene() {
    Scene scene;
    scene.materials.resize(1);
    M44d lie_down;
    lie_down.setAxisAngle(V3d(1, 0, 0), -std::numbers::pi / 2);
    add_instance(scene, add_square(scene, 0), scaled({10, 10, 10}) * lie_down);
    Camera camera;
    camera.vertical_fov = 0.6;
    M44d tilt;
    tilt.setAxisAngle(V3d(1, 0, 0), -1.1);
    M44d turn;
    turn.setAxisAngle(V3d(0, 1, 0), 0.3);
    camera.world_from_camera = tilt * turn * moved({1, 6, 3});
    scene.cameras = {camera};
    return scene;
}

PovConfig small_picture() {
    PovConfig config;
    config.width = 80;
    config.height = 60;
    return config;
}

/// Compares each pixel with expected(point of the floor), which is E.
template <class Irradiance>
void expect_floor(const Picture& picture, const Camera& camera, double tolerance, const Irradiance& expected) {
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            const V3d place = ray_through(camera, x, y, picture.width, picture.height).meets({0, 0, 0}, {0, 1, 0});
            const double irradiance = expected(place);
            if (std::isnan(irradiance)) continue;  // on an edge
            const double shown = picture.at(x, y).x * std::numbers::pi;
            ASSERT_NEAR(shown, irradiance, tolerance * irradiance + 1e-7) << "pixel " << x << ", " << y;
        }
    }
}

TEST_F(PovLight, SunFallsOffWithTheCosine) {
    Scene scene = floor_scene();
    LightSource sun;
    sun.kind = LightKind::sun;
    sun.direction = V3d(1, -1, 0).normalized();
    sun.intensity = C3f(2);
    scene.lights = {sun};
    expect_floor(render(scene, small_picture()), scene.cameras[0], half_float,
                 [](const V3d&) { return 2 / std::sqrt(2.0); });
}

TEST_F(PovLight, PointLightFollowsTheInverseSquare) {
    Scene scene = floor_scene();
    LightSource light;
    light.position = {0.5, 1.5, 0};
    light.intensity = C3f(7);
    scene.lights = {light};
    expect_floor(render(scene, small_picture()), scene.cameras[0], half_float, [](const V3d& place) {
        const V3d way = V3d(0.5, 1.5, 0) - place;
        return 7 * way.y / std::pow(way.length(), 3);
    });
}

TEST_F(PovLight, HardSpotLightsItsConeOnly) {
    Scene scene = floor_scene();
    LightSource light;
    light.kind = LightKind::spot;
    light.position = {0, 2, 0};
    light.direction = V3d(0.2, -1, 0.1).normalized();
    light.intensity = C3f(7);
    light.inner_cone_angle = light.outer_cone_angle = 0.4;
    scene.lights = {light};
    expect_floor(render(scene, small_picture()), scene.cameras[0], half_float, [&](const V3d& place) {
        const V3d way = place - light.position;
        const double angle = std::acos(way.normalized().dot(light.direction));
        if (std::abs(angle - 0.4) < 0.01) return std::nan("");
        return angle < 0.4 ? -7 * way.y / std::pow(way.length(), 3) : 0.0;
    });
}

TEST_F(PovLight, ObjectsShadeEachOther) {
    Scene scene = floor_scene();
    add_instance(scene, 0, moved({0, 0, 1}) * scene.instances[0].world_from_mesh);
    scene.instances[1].world_from_mesh =
        scaled({0.05, 0.05, 0.05}) * scene.instances[0].world_from_mesh * moved({0, 0.5, 0});
    LightSource light;
    light.position = {0, 1, 0};
    light.intensity = C3f(1);
    scene.lights = {light};
    // The square of half size 0.5 at half the height of the light shades one of half size 1; it hides some of that.
    expect_floor(render(scene, small_picture()), scene.cameras[0], half_float, [&](const V3d& place) {
        const V3d seen_through =
            Ray{V3d(0) * scene.cameras[0].world_from_camera, place - V3d(0) * scene.cameras[0].world_from_camera}.meets(
                {0, 0.5, 0}, {0, 1, 0});
        const double in_front = std::max(std::abs(seen_through.x), std::abs(seen_through.z));
        const double in_shade = std::max(std::abs(place.x), std::abs(place.z));
        if (in_front < 0.55 || std::abs(in_shade - 1) < 0.1) return std::nan("");
        if (in_shade < 1) return 0.0;
        const V3d way = light.position - place;
        return way.y / std::pow(way.length(), 3);
    });
}

TEST_F(PovLight, PictureIsTheSameWithEitherAxisUp) {
    Scene scene = floor_scene();
    LightSource light;
    light.position = {0.5, 1.5, 0};
    light.intensity = C3f(7, 5, 3);
    scene.lights = {light};
    OutputInfo z_up;
    z_up.up = UpAxis::z;
    const Picture a = render(scene, small_picture());
    const Picture b = render(scene, small_picture(), z_up);
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        ASSERT_NEAR(a.pixels[i].x, b.pixels[i].x, half_float * a.pixels[i].x);
}

TEST_F(PovLight, TinyAndHugeScenesLookAlike) {
    for (const double scale : {1e-4, 1e6}) {
        Scene scene = floor_scene();
        scene.instances[0].world_from_mesh = scene.instances[0].world_from_mesh * scaled(V3d(scale));
        Camera& camera = scene.cameras[0];
        camera.world_from_camera = camera.world_from_camera * scaled(V3d(scale));
        LightSource light;
        light.position = V3d(0.5, 1.5, 0) * scale;
        light.intensity = C3f(static_cast<float>(7 * scale * scale));
        scene.lights = {light};
        expect_floor(render(scene, small_picture()), camera, 2 * half_float, [&](const V3d& place) {
            const V3d way = (light.position - place) / scale;
            return 7 * way.y / std::pow(way.length(), 3);
        });
    }
}

/// A plate that sees nothing but a sky of radiance L gets E = pi L.
TEST_F(PovLight, ConstantSkyLightsAndShows) {
    Scene scene = floor_scene();
    scene.materials[0].base_color = {0.5F, 0.5F, 0.5F, 1};
    scene.instances[0].world_from_mesh = scaled({0.1, 0.1, 0.1}) * scene.instances[0].world_from_mesh;
    PovConfig config = small_picture();
    config.sky = {2, 1, 0.5F};
    config.bounces = 1;
    const Camera& camera = scene.cameras[0];
    const Picture picture = render(scene, config);
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            const V3d place = ray_through(camera, x, y, picture.width, picture.height).meets({0, 0, 0}, {0, 1, 0});
            const double reach = std::max(std::abs(place.x), std::abs(place.z));
            if (std::abs(reach - 1) < 0.1) continue;
            ASSERT_NEAR(picture.at(x, y).x, reach < 1 ? 1 : 2, 0.002) << x << ", " << y;
            ASSERT_NEAR(picture.at(x, y).z, reach < 1 ? 0.25 : 0.5, 0.002) << x << ", " << y;
        }
    }
}

/// Its centre lies along +X, its right half along +Z, its top at +Y.
TEST_F(PovLight, SkyPictureIsTurnedLikeBlenders) {
    Picture sky;
    sky.width = 64;
    sky.height = 32;
    for (int y = 0; y < sky.height; ++y)
        for (int x = 0; x < sky.width; ++x)
            sky.pixels.emplace_back(static_cast<float>(x) / 64.0F, static_cast<float>(y) / 32.0F, 3.0F);
    Scene scene = square_under_sun();
    Camera camera;
    camera.vertical_fov = 0.5;
    PovConfig config = small_picture();
    config.sky_picture = sky;
    for (const UpAxis up : {UpAxis::y, UpAxis::z}) {
        for (const double turn : {0.0, 1.0, -2.0}) {
            camera.world_from_camera.setAxisAngle(V3d(0, 1, 0), turn);
            M44d tilt;
            tilt.setAxisAngle(V3d(1, 0, 0), 0.4);
            camera.world_from_camera = tilt * camera.world_from_camera * moved({0, 0, -5});
            scene.instances[0].world_from_mesh = scaled(V3d(1e-3));
            config.camera = camera;
            OutputInfo info;
            info.up = up;
            const Picture picture = render(scene, config, info);
            for (int y = 0; y < picture.height; y += 7) {
                for (int x = 0; x < picture.width; x += 7) {
                    const V3d d = ray_through(camera, x, y, picture.width, picture.height).direction;
                    const double u = 0.5 + std::atan2(d.z, d.x) / (2 * std::numbers::pi);
                    const double v = std::acos(d.y) / std::numbers::pi;
                    if (u < 0.03 || u > 0.97) continue;  // the seam
                    // The gradient runs from texel to texel.
                    ASSERT_NEAR(picture.at(x, y).x, u - 0.5 / 64, 0.004) << turn;
                    ASSERT_NEAR(picture.at(x, y).y, v - 0.5 / 32, 0.004) << turn;
                    ASSERT_NEAR(picture.at(x, y).z, 3, 0.01);
                }
            }
        }
    }
}

/// Between two large parallel plates, one of which emits Le, the other of albedo rho shows rho * Le.
TEST_F(PovLight, EmissiveSurfaceLightsThroughRadiosity) {
    Scene scene = floor_scene();
    scene.materials.resize(2);
    scene.materials[0].base_color = {0.6F, 0.6F, 0.6F, 1};
    scene.materials[1].base_color = {0, 0, 0, 1};
    scene.materials[1].emission = {3, 2, 1};
    M44d face_down;
    face_down.setAxisAngle(V3d(1, 0, 0), std::numbers::pi / 2);
    add_instance(scene, add_square(scene, 1), scaled({1e4, 1e4, 1e4}) * face_down * moved({0, 8, 0}));
    scene.instances[0].world_from_mesh = scene.instances[0].world_from_mesh * scaled(V3d(2));
    PovConfig config = small_picture();
    config.bounces = 1;
    const Picture picture = render(scene, config);
    double sum = 0;
    for (const C3f& pixel : picture.pixels) sum += pixel.x;
    EXPECT_NEAR(sum / static_cast<double>(picture.pixels.size()), 0.6 * 3, 0.02);
}

}  // namespace
}  // namespace vmap
