// SPDX-License-Identifier: GPL-3.0-or-later
#include <vmap/light_source.h>

#include <gtest/gtest.h>

#include <cmath>

namespace vmap {
namespace {

LightSource spot(double inner, double outer) {
    LightSource light;
    light.kind = LightKind::spot;
    light.inner_cone_angle = inner;
    light.outer_cone_angle = outer;
    return light;
}

TEST(SpotFalloff, FullInsideTheInnerCone) {
    EXPECT_EQ(spot_falloff(spot(0.3, 0.6), std::cos(0.29)), 1.0);
}

TEST(SpotFalloff, NothingOutsideTheOuterCone) {
    EXPECT_EQ(spot_falloff(spot(0.3, 0.6), std::cos(0.61)), 0.0);
}

TEST(SpotFalloff, SquareOfTheCosineRampBetween) {
    const double middle = 0.5 * (std::cos(0.3) + std::cos(0.6));
    EXPECT_NEAR(spot_falloff(spot(0.3, 0.6), middle), 0.25, 1e-12);
}

TEST(SpotFalloff, HardConeHasNoRamp) {
    EXPECT_EQ(spot_falloff(spot(0.5, 0.5), std::cos(0.499)), 1.0);
    EXPECT_EQ(spot_falloff(spot(0.5, 0.5), std::cos(0.501)), 0.0);
}

}  // namespace
}  // namespace vmap
