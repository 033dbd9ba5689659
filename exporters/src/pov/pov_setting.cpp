// SPDX-License-Identifier: GPL-3.0-or-later
#include "pov_setting.h"

#include <vmap/error.h>
#include <vmap/printable.h>
#include <vmap/version.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string_view>

namespace vmap {
namespace {

using Imath::C3f;
using Imath::V3d;

constexpr int most_bounces = 20;  // POV-Ray's own limit

/// Distance over which POV-Ray softens the inverse square, as a share of the scene.
constexpr double fade_share = 1e-3;

struct Quality {
    std::string_view name;
    int bounces;
    int count;
    int nearest_count;
    double error_bound;
    double pretrace_end;
    std::string_view sampling;  ///< options of povray
};

Quality quality_of(PovPreset preset) {
    switch (preset) {
        case PovPreset::draft:
            return {"draft", 2, 60, 5, 0.8, 0.04, "-A"};
        case PovPreset::reference:
            return {"reference", 12, 1600, 20, 0.1, 0.005, "+A0.05 +AM2 +R3"};
        case PovPreset::normal:
            break;
    }
    return {"normal", 5, 400, 10, 0.25, 0.01, "+A0.1 +AM2 +R2"};
}

int bounces_of(const PovConfig& config) {
    return config.bounces.value_or(quality_of(config.preset).bounces);
}

bool is_finite(const V3d& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// A light along its direction: where it stands, where it points.
struct Axis {
    V3d from;
    V3d to;
};

Axis axis_of(const LightSource& light, const PovFrame& frame) {
    V3d direction;
    frame.frame_from_world.multDirMatrix(light.direction, direction);
    direction.normalize();
    if (light.kind == LightKind::sun) return {frame.center - direction * (2 * frame.diameter), frame.center};
    const V3d position = light.position * frame.frame_from_world;
    return {position, position + direction * frame.diameter};
}

void write_light(PovText& text, const LightSource& light, const PovFrame& frame) {
    const auto degrees = [](double radians) { return radians * 180 / std::numbers::pi; };
    const Axis axis = axis_of(light, frame);
    text.line("light_source {{ // {}", header_text(light.name));
    if (light.kind == LightKind::sun) {
        text.line("    {} {}", pov_vector(axis.from), pov_color(light.intensity * std::numbers::inv_pi_v<float>));
        text.line("    parallel point_at {}", pov_vector(axis.to));
    } else {
        // In world units the fading distance would be smaller by the scale: intensity / (2 pi f^2) would not.
        const double fade = fade_share * frame.diameter / frame.scale;
        const auto factor = static_cast<float>(1 / (2 * std::numbers::pi * fade * fade));
        text.line("    {} {}", pov_vector(axis.from), pov_color(light.intensity * factor));
        text.line("    fade_power 2 fade_distance {}", fade_share * frame.diameter);
        if (light.kind == LightKind::spot)
            text.line("    spotlight point_at {} radius {} falloff {} tightness 0", pov_vector(axis.to),
                      degrees(light.inner_cone_angle), degrees(light.outer_cone_angle));
    }
    text.line("}}");
}

}  // namespace

void check_config(const PovConfig& config, const std::string& path) {
    const auto refuse = [&](const std::string& found) { throw UsageError(printable(path) + ": " + found); };
    if (config.bounces && (*config.bounces < 0 || *config.bounces > most_bounces))
        refuse(fmt::format("{} bounces, POV-Ray does 0 to {}", *config.bounces, most_bounces));
    if (config.width < 1 || config.height < 1)
        refuse(fmt::format("a picture of {} x {} pixels, expected at least 1 x 1", config.width, config.height));
    if (!is_finite(V3d(config.sky)) || config.sky.x < 0 || config.sky.y < 0 || config.sky.z < 0)
        refuse(fmt::format("sky {},{},{}, expected three numbers that are not negative", config.sky.x, config.sky.y,
                           config.sky.z));
}

std::string plain_name(const std::string& name) {
    const auto is_plain = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '-';
    };
    std::string plain = name;
    std::replace_if(plain.begin(), plain.end(), [&](char c) { return !is_plain(c); }, '_');
    if (plain.empty() || plain.front() == '-') plain.insert(plain.begin(), '_');
    return plain;
}

std::string pov_command_name(const std::string& path) {
    std::string name = std::filesystem::path(path).filename().string();
    if (name == plain_name(name)) return name;
    std::string word = "'";
    for (const char c : printable(name)) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return word + "'";
}

std::string pov_picture_name(const std::string& path) {
    return plain_name(std::filesystem::path(path).stem().string()) + ".exr";
}

void write_conventions(PovText& text, const OutputInfo& info, const PovFrame& frame) {
    text.line("// up {}", name_of(info.up));
    text.line("// light_units {} punctual {} directional {}", name_of(info.light_units),
              punctual_factor(info.light_units), directional_factor(info.light_units));
    text.line("// scale {} units of this file in a world unit", frame.scale);
}

void write_header(PovText& text, const std::string& path, const OutputInfo& info, const PovConfig& config,
                  const PovFrame& frame) {
    const Quality quality = quality_of(config.preset);
    text.line("// {}", header_text(info.source));
    text.line("// Written by vmap {}. Run in this folder:", version);
    text.line("//   povray +I{} +O{} +FE +W{} +H{} {} +WT1 -D", pov_command_name(path), pov_picture_name(path),
              config.width, config.height, quality.sampling);
    text.line("// Preset {}, {} bounces. +WT1: with more threads the radiosity differs from run to run.", quality.name,
              bounces_of(config));
    text.line("//");
    write_conventions(text, info, frame);
    text.line("//");
    text.line("// quantity                                          is written here as");
    text.line("// radiance L of a pixel [W/(m^2 sr)]                colour, linear Rec.709");
    text.line("// irradiance E of a surface of albedo rho [W/m^2]   pi * colour / rho");
    text.line("// sun of irradiance E [W/m^2]                       parallel light of colour E/pi");
    text.line(
        "// point, spot of intensity I [W/sr]                 colour I/(2 pi f^2), fade_power 2, fade_distance f;");
    text.line("//                                                   f = {} of the scene, I and f in world units",
              fade_share);
    text.line("// emission Le [W/(m^2 sr)] over albedo rho          finish emission Le/rho with pigment rho");
    text.line("// back of a single-sided surface                    interior_texture, black");
    text.line("");
}

void write_globals(PovText& text, const PovConfig& config) {
    const Quality quality = quality_of(config.preset);
    text.line("#version 3.7;");
    text.line("global_settings {{");
    text.line("    assumed_gamma 1");
    text.line("    ambient_light 0");
    text.line("    max_trace_level 40");
    text.line("    adc_bailout 1e-5");
    if (const int bounces = bounces_of(config); bounces > 0) {
        text.line("    radiosity {{");
        text.line("        pretrace_start 0.08");
        text.line("        pretrace_end {}", quality.pretrace_end);
        text.line("        count {}", quality.count);
        text.line("        nearest_count {}", quality.nearest_count);
        text.line("        error_bound {}", quality.error_bound);
        text.line("        low_error_factor 0.5");
        text.line("        recursion_limit {}", bounces);
        text.line("        gray_threshold 0");
        text.line("        brightness 1");
        text.line("        adc_bailout 1e-5");
        text.line("        always_sample off");
        text.line("        normal off");
        text.line("        media off");
        text.line("    }}");
    }
    text.line("}}");
    text.line("#default {{ finish {{ ambient 0 diffuse 1 emission 0 specular 0 }} }}");
    text.line("");
}

void write_sky(PovText& text, const PovConfig& config, const PovFrame& frame, const std::string& sky_file) {
    if (!sky_file.empty()) {
        // POV-Ray's spherical images begin along +x, ours have their centre there.
        Imath::M44d turn = frame.frame_from_world;
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column) turn[row][column] /= frame.scale;
        text.line("sky_sphere {{ pigment {{ image_map {{ exr \"{}\" map_type 1 interpolate 2 }} rotate y*180 {} }} }}",
                  sky_file, pov_matrix(turn));
    } else if (config.sky != C3f(0, 0, 0)) {
        text.line("background {{ {} }}", pov_color(config.sky));
    }
}

void write_lights(PovText& text, std::span<const LightSource> lights, const PovFrame& frame, const std::string& path) {
    for (const LightSource& light : lights) {
        const bool finite = is_finite(light.position) && is_finite(light.direction) &&
                            is_finite(V3d(light.intensity)) && std::isfinite(light.inner_cone_angle) &&
                            std::isfinite(light.outer_cone_angle);
        if (!finite)
            throw UnsupportedInput(printable(path) + ": light '" + header_text(light.name) +
                                   "' has a number that is not finite");
        write_light(text, light, frame);
    }
    if (!lights.empty()) text.line("");
}

}  // namespace vmap
