// SPDX-License-Identifier: GPL-3.0-or-later
// KHR_lights_punctual and cameras, in the frames of the nodes that will carry them.
#include "../content_error.h"
#include "../warnings.h"
#include "document_parts.h"
#include "json_object.h"

#include <vmap/printable.h>

#include <fmt/format.h>

#include <array>
#include <limits>
#include <numbers>

namespace vmap::gltf {
namespace {

LightKind read_kind(const JsonObject& object) {
    const std::string type = object.required(object.text("type"), "type");
    if (type == "point") return LightKind::point;
    if (type == "spot") return LightKind::spot;
    if (type == "directional") return LightKind::sun;
    object.fail("type", "point, spot or directional");
}

void read_cone(const JsonObject& object, LightSource& light) {
    const JsonObject spot = object.required(object.object("spot"), "spot");
    const Range up_to_right_angle{0, std::numbers::pi / 2 + 1e-6};
    light.inner_cone_angle = spot.number("innerConeAngle", up_to_right_angle).value_or(0);
    light.outer_cone_angle = spot.number("outerConeAngle", up_to_right_angle).value_or(std::numbers::pi / 4);
    if (!(light.inner_cone_angle < light.outer_cone_angle))
        throw BrokenContent(fmt::format("{}.spot.innerConeAngle is not below outerConeAngle", object.where()));
}

LightSource read_light(const JsonObject& object, std::size_t index, LightUnits units, Warnings& warnings) {
    LightSource light;
    light.kind = read_kind(object);
    light.name = printable(object.text("name").value_or(fmt::format("light {}", index)));

    std::array<double, 3> color{1, 1, 1};
    object.numbers("color", color, not_negative);
    const double factor = light.kind == LightKind::sun ? directional_factor(units) : punctual_factor(units);
    const double intensity = object.number("intensity", not_negative).value_or(1) * factor;
    for (int i = 0; i < 3; ++i) {
        if (!(color[i] * intensity <= std::numeric_limits<float>::max()))
            throw BrokenContent(object.where() + ".intensity is more than a float can hold");
        light.intensity[i] = static_cast<float>(color[i] * intensity);
    }
    if (light.kind == LightKind::spot) read_cone(object, light);
    if (object.number("range", above_zero))
        warnings.add("the range of lights is not used: their light reaches everywhere", light.name);
    return light;
}

Camera read_camera(const JsonObject& object, std::size_t index) {
    Camera camera;
    camera.name = printable(object.text("name").value_or(fmt::format("camera {}", index)));
    const std::string type = object.required(object.text("type"), "type");
    if (type == "perspective") {
        const JsonObject perspective = object.required(object.object("perspective"), "perspective");
        const Range below_half_turn{above_zero.least, std::numbers::pi - 1e-6};
        camera.vertical_fov = perspective.required(perspective.number("yfov", below_half_turn), "yfov");
        camera.aspect = perspective.number("aspectRatio", above_zero).value_or(0);
    } else if (type == "orthographic") {
        const JsonObject orthographic = object.required(object.object("orthographic"), "orthographic");
        camera.orthographic = true;
        camera.half_height = orthographic.required(orthographic.number("ymag", above_zero), "ymag");
        camera.aspect = orthographic.required(orthographic.number("xmag", above_zero), "xmag") / camera.half_height;
    } else {
        object.fail("type", "perspective or orthographic");
    }
    return camera;
}

}  // namespace

void read_lights(const JsonObject& root, LightUnits units, Document& document, Warnings& warnings) {
    const std::optional<JsonObject> extension = root.extension("KHR_lights_punctual");
    if (!extension) return;
    document.lights.reserve(extension->array_size("lights"));
    extension->for_each("lights", [&](const JsonObject& object, std::size_t index) {
        document.lights.push_back(read_light(object, index, units, warnings));
    });
}

void read_cameras(const JsonObject& root, Document& document) {
    document.cameras.reserve(root.array_size("cameras"));
    root.for_each("cameras", [&](const JsonObject& object, std::size_t index) {
        document.cameras.push_back(read_camera(object, index));
    });
}

}  // namespace vmap::gltf
