// SPDX-License-Identifier: GPL-3.0-or-later
#include "parse_values.h"

#include <vmap/error.h>

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace vmap {
namespace {

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    for (;;) {
        const std::size_t end = text.find(separator);
        parts.push_back(text.substr(0, end));
        if (end == std::string_view::npos) return parts;
        text.remove_prefix(end + 1);
    }
}

}  // namespace

std::vector<double> parse_numbers(std::string_view option, std::string_view text, std::size_t least, std::size_t most) {
    std::vector<double> numbers;
    for (const std::string_view part : split(text, ',')) {
        double number = 0;
        const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), number);
        if (error != std::errc() || end != part.data() + part.size() || !std::isfinite(number))
            throw UsageError(fmt::format("{} {}: '{}' is not a number", option, text, part));
        numbers.push_back(number);
    }
    if (numbers.size() < least || numbers.size() > most)
        throw UsageError(fmt::format("{} {}: {} numbers; expected {}", option, text, numbers.size(),
                                     least == most ? fmt::format("{}", least) : fmt::format("{} to {}", least, most)));
    return numbers;
}

Imath::V3d parse_vector(std::string_view option, std::string_view text) {
    const std::vector<double> n = parse_numbers(option, text, 3, 3);
    return {n[0], n[1], n[2]};
}

Imath::C3f parse_color(std::string_view option, std::string_view text) {
    std::vector<double> n = parse_numbers(option, text, 1, 3);
    if (n.size() == 2) throw UsageError(fmt::format("{} {}: 2 numbers; expected 1 or 3", option, text));
    n.resize(3, n[0]);
    for (const double value : n)
        if (value < 0) throw UsageError(fmt::format("{} {}: light cannot be negative", option, text));
    return {static_cast<float>(n[0]), static_cast<float>(n[1]), static_cast<float>(n[2])};
}

LightSource parse_light(std::string_view text) {
    const std::vector<std::string_view> parts = split(text, ':');
    if (parts.size() != 3 || (parts[0] != "point" && parts[0] != "sun"))
        throw UsageError(fmt::format("--light {}: expected point:X,Y,Z:INTENSITY or sun:DX,DY,DZ:IRRADIANCE", text));
    LightSource light;
    light.name = std::string(text);
    light.intensity = parse_color("--light", parts[2]);
    const Imath::V3d vector = parse_vector("--light", parts[1]);
    if (parts[0] == "point") {
        light.position = vector;
        return light;
    }
    light.kind = LightKind::sun;
    if (!(vector.length() > 0)) throw UsageError(fmt::format("--light {}: a direction cannot be 0,0,0", text));
    light.direction = vector.normalized();
    return light;
}

}  // namespace vmap
