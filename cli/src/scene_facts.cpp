// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_facts.h"

#include <vmap/exporters/output_info.h>
#include <vmap/importers/prepare_cloud.h>
#include <vmap/importers/sample_surface.h>
#include <vmap/printable.h>
#include <vmap/surface_shading.h>

#include <Imath/ImathBox.h>
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace vmap {
namespace {

using Imath::V3d;
using Json = nlohmann::ordered_json;

struct Summary {
    std::size_t triangles = 0;
    std::size_t points = 0;
    double area = 0;               ///< of the surface's fronts, or of the points
    double double_sided_area = 0;  ///< of the part of it whose backs are surface too
    double emissive_area = 0;      ///< of the part of it that emits
    Imath::Box3d box;              ///< of triangles and points
};

void add_surface(const Scene& scene, Summary& summary) {
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
        const Material& material = scene.materials[mesh.material];
        summary.triangles += mesh.triangle_count();
        double sum = 0;
        for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
            sum += world_area_normal(scene, i, t).length() / 2;
            for (const V3d& v : world_triangle(scene, i, t)) summary.box.extendBy(v);
        }
        summary.area += sum;
        if (material.double_sided) summary.double_sided_area += sum;
        if (material.emits()) summary.emissive_area += sum;
    }
}

void add_points(const PointCloud& points, bool are_used, Summary& summary) {
    summary.points = points.size();
    for (const Imath::V3f& p : points.positions) summary.box.extendBy(points.origin + V3d(p));
    if (!are_used) return;
    for (std::size_t i = 0; i < points.areas.size(); ++i) {
        const auto area = static_cast<double>(points.areas[i]);
        summary.area += area;
        if (points.emits() && points.emission[i] != Imath::C3f(0, 0, 0)) summary.emissive_area += area;
    }
}

Summary summarize(const Input& input) {
    Summary summary;
    add_surface(input.scene, summary);
    if (input.points) add_points(input.points->cloud.points, input.scene.instances.empty(), summary);
    return summary;
}

Json numbers(const V3d& v) {
    return {v.x, v.y, v.z};
}
Json numbers(const Imath::C3f& c) {
    return {c.x, c.y, c.z};
}

double degrees(double radians) {
    return radians * 180 / std::numbers::pi;
}

Json facts_of(const LightSource& light) {
    Json json{{"name", printable(light.name)}};
    json["kind"] = light.kind == LightKind::sun ? "sun" : light.kind == LightKind::spot ? "spot" : "point";
    if (light.kind != LightKind::sun) json["position"] = numbers(light.position);
    if (light.kind != LightKind::point) json["direction"] = numbers(light.direction);
    json[light.kind == LightKind::sun ? "irradiance" : "intensity"] = numbers(light.intensity);
    if (light.kind == LightKind::spot)
        json["cone_degrees"] = {degrees(light.inner_cone_angle), degrees(light.outer_cone_angle)};
    return json;
}

Json facts_of(const Camera& camera) {
    const Imath::M44d& m = camera.world_from_camera;
    Json json{{"name", printable(camera.name)},
              {"position", numbers(V3d(m[3][0], m[3][1], m[3][2]))},
              {"direction", numbers(-V3d(m[2][0], m[2][1], m[2][2]).normalized())}};
    if (camera.orthographic)
        json["half_height"] = camera.half_height;
    else
        json["vertical_fov_degrees"] = degrees(camera.vertical_fov);
    return json;
}

template <class T>
Json list_of(const std::vector<T>& items) {
    constexpr std::size_t most = 100;  // a file may have a light a byte
    Json list = Json::array();
    for (std::size_t i = 0; i < std::min(items.size(), most); ++i) list.push_back(facts_of(items[i]));
    return list;
}

/// Attributes of the points that the file has, in the words of the PLY files.
Json attributes_of(const LitCloud& cloud) {
    Json names = Json::array();
    const PointCloud& points = cloud.points;
    if (!points.normals.empty()) names.push_back("normal");
    if (!points.areas.empty()) names.push_back("area");
    if (!points.albedo.empty()) names.push_back("albedo");
    if (!points.emission.empty()) names.push_back("emission");
    if (!cloud.irradiance.empty()) names.push_back("irradiance");
    if (!points.faces.empty()) names.push_back("face_id");
    if (!points.materials.empty()) names.push_back("material_id");
    return names;
}

void tell_preparation(const PointCloud& points, Json& steps) {
    if (is_complete(points)) {
        steps.push_back("take the points as they are");
        return;
    }
    std::string missing;
    const auto add = [&](bool lacks, const char* what) {
        if (lacks) missing += (missing.empty() ? "" : ", ") + std::string(what);
    };
    add(points.normals.empty(), "normals and their sides (--viewpoint, --orient)");
    add(points.areas.empty(), "areas");
    add(points.albedo.empty(), "albedo 0.8");
    steps.push_back("estimate what the points lack: " + missing);
}

/// What vmap light would do without further options, step by step.
Json plan_of(const Input& input, const Summary& summary) {
    Json steps = Json::array();
    if (input.scene.instances.empty() && input.points) {
        tell_preparation(input.points->cloud.points, steps);
        if (!input.points->cloud.irradiance.empty()) steps.push_back("compute the irradiance anew");
    } else {
        const double spacing = std::sqrt(summary.area / static_cast<double>(SampleConfig::default_points));
        steps.push_back(fmt::format("sample {} points on the surface, about {:.2g} apart or more (--points, --spacing)",
                                    SampleConfig::default_points, spacing));
        if (input.points) steps.push_back("leave out the points that the file holds beside its meshes");
    }
    const bool emits = summary.emissive_area > 0 || (input.points && input.points->cloud.points.emits());
    const std::size_t lights = input.scene.lights.size();
    if (lights == 0 && !emits)
        steps.push_back("refuse: nothing emits light (--light adds some)");
    else
        steps.push_back(fmt::format("light them by {} light{} and {:.4g} of emitting area", lights,
                                    lights == 1 ? "" : "s", summary.emissive_area));
    return steps;
}

}  // namespace

Json scene_facts(const std::string& file, const Input& input) {
    const Scene& scene = input.scene;
    const Summary summary = summarize(input);
    Json json{{"input", printable(file)},
              {"format", input.facts.format},
              {"up", name_of(input.facts.up)},
              {"vertices", input.facts.vertices},
              {"polygons", input.facts.polygons},
              {"triangles", summary.triangles},
              {"points", summary.points},
              {"meshes", scene.meshes.size()},
              {"instances", scene.instances.size()},
              {"materials", scene.materials.size()},
              {"images", scene.images.size()},
              {"area", summary.area},
              {"double_sided_area", summary.double_sided_area},
              {"emissive_area", summary.emissive_area},
              {"lights", scene.lights.size()},
              {"cameras", scene.cameras.size()}};
    if (!summary.box.isEmpty()) json["box"] = {numbers(summary.box.min), numbers(summary.box.max)};
    if (input.points) json["point_attributes"] = attributes_of(input.points->cloud);
    json["light_list"] = list_of(scene.lights);
    json["camera_list"] = list_of(scene.cameras);
    json["extensions"] = scene.extensions;
    json["light_would"] = plan_of(input, summary);
    json["warnings"] = Json::array();
    for (const std::string& warning : scene.warnings) json["warnings"].push_back(printable(warning));
    return json;
}

}  // namespace vmap
