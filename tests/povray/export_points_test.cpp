// SPDX-License-Identifier: GPL-3.0-or-later
#include "pov_picture.h"

#include <vmap/error.h>
#include <vmap/exporters/file_writer.h>
#include <vmap/exporters/pov_points.h>

#include <gtest/gtest.h>

#include <numbers>

namespace vmap {
namespace {

using Imath::C3f;

class PovPoints : public PovRayTest {
protected:
    [[nodiscard]] Picture render_points(const LitCloud& cloud, PovPointsConfig config = {}) const {
        config.width = config.height = 40;
        FileWriter file(path("lit.pov"));
        write_pov_points(file, cloud, {}, config);
        file.commit();
        return render_file("lit.pov", config.width, config.height);
    }
};

/// Points of one side of the square [-1, 1]^2 in the plane z = 0, with the same light everywhere.
void add_sheet(LitCloud& cloud, const Imath::V3f& normal, const C3f& irradiance) {
    constexpr int side = 40;
    for (int i = 0; i < side * side; ++i) {
        const int column = i % side, row = i / side;
        cloud.points.positions.emplace_back(static_cast<float>(column) / 20 - 0.975F,
                                            static_cast<float>(row) / 20 - 0.975F, 0.0F);
        cloud.points.normals.push_back(normal);
        cloud.points.areas.push_back(4.0F / (side * side));
        cloud.points.albedo.emplace_back(0.5F, 0.5F, 0.5F);
        cloud.irradiance.push_back(irradiance);
    }
}

TEST_F(PovPoints, DiscsCoverTheSurfaceAndShowItsRadiance) {
    LitCloud cloud;
    add_sheet(cloud, {0, 0, 1}, {2 * std::numbers::pi_v<float>, 1e4F, 0});
    PovPointsConfig config;
    config.camera = camera_over_square();
    const Picture picture = render_points(cloud, config);
    for (int y = 1; y < 39; ++y)
        for (int x = 1; x < 39; ++x) {
            ASSERT_NEAR(picture.at(x, y).x, 1, 0.001);
            ASSERT_NEAR(picture.at(x, y).y, 5000 / std::numbers::pi, 2);
        }
}

TEST_F(PovPoints, EachSideOfASheetShowsItsOwnLight) {
    LitCloud cloud;
    add_sheet(cloud, {0, 0, 1}, C3f(2 * std::numbers::pi_v<float>));
    add_sheet(cloud, {0, 0, -1}, C3f(0.5F * std::numbers::pi_v<float>));
    PovPointsConfig config;
    config.camera = camera_over_square();
    Picture picture = render_points(cloud, config);
    for (int i = 1; i < 39; ++i) ASSERT_NEAR(picture.at(i, i).x, 1, 0.001);
    config.camera->world_from_camera = scaled({-1, 1, -1}) * moved({0, 0, -5});
    picture = render_points(cloud, config);
    for (int i = 1; i < 39; ++i) ASSERT_NEAR(picture.at(i, i).x, 0.25, 0.001);
}

TEST_F(PovPoints, BackOfASheetIsBlackAndSpheresAreNot) {
    LitCloud cloud;
    add_sheet(cloud, {0, 0, -1}, C3f(2 * std::numbers::pi_v<float>));
    PovPointsConfig config;
    config.camera = camera_over_square();
    EXPECT_EQ(render_points(cloud, config).at(20, 20).x, 0);
    config.shape = PovPointShape::spheres;
    EXPECT_NEAR(render_points(cloud, config).at(20, 20).x, 1, 0.001);
}

TEST_F(PovPoints, CloudWithoutNormalsOrAreasOrLightIsShown) {
    LitCloud cloud;
    add_sheet(cloud, {0, 0, 1}, C3f(1));
    cloud.points.normals.clear();
    cloud.points.areas.clear();
    cloud.irradiance.clear();
    cloud.points.origin = {1e6, 2e6, 3e6};
    const Picture picture = render_points(cloud);  // from a camera that sees everything
    EXPECT_NEAR(picture.at(20, 20).x, 0.5, 0.001);
    EXPECT_EQ(picture.at(0, 0).x, 0);
}

TEST_F(PovPoints, NoPointsIsAValidScene) {
    EXPECT_EQ(render_points({}).at(20, 20), C3f(0));
}

TEST_F(PovPoints, ScalesThatMakeNoSenseAreUsageErrors) {
    FileWriter file(path("lit.pov"));
    for (const double scale : {0.0, -1.0, std::nan("")}) {
        PovPointsConfig config;
        config.radius_scale = scale;
        EXPECT_THROW(write_pov_points(file, {}, {}, config), UsageError);
    }
}

}  // namespace
}  // namespace vmap
