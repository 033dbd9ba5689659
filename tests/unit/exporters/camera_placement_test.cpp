// SPDX-License-Identifier: GPL-3.0-or-later
#include <vmap/exporters/camera_placement.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../importers/test_scenes.h"

namespace vmap {
namespace {

using Imath::Box3d;
using Imath::V3d;

/// Largest share of the half width and half height that a corner of the box takes; above 1 it is outside the picture.
double fill_of(const Camera& camera, const Box3d& box, double aspect) {
    const Imath::M44d camera_from_world = camera.world_from_camera.inverse();
    double fill = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const V3d world((corner & 1) != 0 ? box.max.x : box.min.x, (corner & 2) != 0 ? box.max.y : box.min.y,
                        (corner & 4) != 0 ? box.max.z : box.min.z);
        const V3d p = world * camera_from_world;
        if (p.z >= 0) return 1e9;
        const double half_height = std::tan(camera.vertical_fov / 2) * -p.z;
        fill = std::max({fill, std::abs(p.y) / half_height, std::abs(p.x) / (half_height * aspect)});
    }
    return fill;
}

TEST(CameraPlacement, ShowsEveryCornerAndFillsThePicture) {
    for (const double aspect : {0.25, 1.0, 16.0 / 9, 6.0})
        for (const Box3d& box :
             {Box3d(V3d(-1), V3d(1)), Box3d(V3d(10, -3, 4), V3d(11, 40, 4.5)), Box3d(V3d(0), V3d(100, 0, 1)),
              Box3d(V3d(4.5e6), V3d(4.5e6 + 3)), Box3d(V3d(-1e-6), V3d(1e-6)), Box3d(V3d(0), V3d(0, 5, 0))}) {
            const double fill = fill_of(place_camera(box, aspect), box, aspect);
            EXPECT_LE(fill, 1) << "aspect " << aspect << ", box from " << box.min << " to " << box.max;
            EXPECT_GE(fill, 0.9) << "aspect " << aspect << ", box from " << box.min << " to " << box.max;
        }
}

TEST(CameraPlacement, FrameIsARotation) {
    const Imath::M44d m = place_camera(Box3d(V3d(1), V3d(2))).world_from_camera;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(V3d(m[i][0], m[i][1], m[i][2]).dot(V3d(m[k][0], m[k][1], m[k][2])), i == k ? 1 : 0, 1e-12);
    EXPECT_NEAR(m.determinant(), 1, 1e-12);
}

TEST(CameraPlacement, OnePlaceOrNoneIsSeenFromADistance) {
    for (const Box3d& box : {Box3d(), Box3d(V3d(0)), Box3d(V3d(3, 4, 5)), Box3d(V3d(1e9))}) {
        const Box3d seen = box.isEmpty() ? Box3d(V3d(0)) : box;
        EXPECT_LE(fill_of(place_camera(box), seen, 1), 1e-6);
    }
}

TEST(CameraPlacement, BoundsFollowInstancesAndOrigins) {
    Imath::M44d moved;
    moved.setTranslation(V3d(1, 2, 3));
    const Scene scene = test::scene_of(test::box_mesh({1, 2, 3}), {}, moved);
    EXPECT_EQ(bounds_of(scene), Box3d(V3d(1, 2, 3), V3d(2, 4, 6)));
    EXPECT_TRUE(bounds_of(Scene()).isEmpty());

    PointCloud cloud;
    EXPECT_TRUE(bounds_of(cloud).isEmpty());
    cloud.origin = V3d(4.5e6, 0, 0);
    cloud.positions = {{0, 0, 0}, {1, -1, 2}};
    EXPECT_EQ(bounds_of(cloud), Box3d(V3d(4.5e6, -1, 0), V3d(4.5e6 + 1, 0, 2)));
}

}  // namespace
}  // namespace vmap
