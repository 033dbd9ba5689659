// SPDX-License-Identifier: Apache-2.0
/// \file
/// Light sources without a surface: point, spot and sun. Emissive surfaces are points of the cloud.
#pragma once

#include <Imath/ImathColor.h>
#include <Imath/ImathVec.h>

#include <numbers>
#include <string>

namespace vmap {

enum class LightKind { point, spot, sun };

/// One light. Its irradiance on a surface element at distance d under the incidence angle t is
///   point: intensity * cos(t) / d^2;
///   spot:  the same, times spot_falloff of the angle from the axis;
///   sun:   intensity * cos(t), at any distance.
struct LightSource {
    LightKind kind = LightKind::point;
    std::string name;
    Imath::V3d position{0, 0, 0};                    ///< world; not used by a sun
    Imath::V3d direction{0, 0, -1};                  ///< unit, the way the light travels; not used by a point
    Imath::C3f intensity{0, 0, 0};                   ///< W/sr (point, spot) or W/m^2 (sun), linear Rec.709
    double inner_cone_angle = 0;                     ///< radians from the axis; full intensity inside
    double outer_cone_angle = std::numbers::pi / 4;  ///< radians from the axis; no light outside

    friend bool operator==(const LightSource&, const LightSource&) = default;
};

/// Share of a spot's intensity at an angle from its axis: 1 inside the inner cone, 0 outside the outer cone, between
/// them the square of the linear ramp in the cosine (KHR_lights_punctual).
///
/// - cos_angle: cosine of the angle between the spot's direction and the way to the lit point
[[nodiscard]] double spot_falloff(const LightSource& spot, double cos_angle);

}  // namespace vmap
