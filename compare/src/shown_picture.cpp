// SPDX-License-Identifier: GPL-3.0-or-later
#include <vmap/compare/error_colors.h>
#include <vmap/compare/shown_picture.h>
#include <vmap/exporters/base64.h>
#include <vmap/srgb.h>

#include <png.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace vmap {
namespace {

/// Stands where a map has no value; darker than no colour of the scale is grey.
constexpr std::uint8_t no_value = 112;

}  // namespace

double exposure_for(const Picture& picture) {
    std::vector<float> brightness;
    brightness.reserve(picture.pixels.size());
    for (const Imath::C3f& pixel : picture.pixels) brightness.push_back(std::max({pixel.x, pixel.y, pixel.z}));
    const auto high =
        brightness.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(brightness.size() - 1));
    std::nth_element(brightness.begin(), high, brightness.end());
    return *high > 0 ? 0.9 / *high : 1;
}

ShownPicture shown_picture(const Picture& picture, double exposure) {
    ShownPicture shown{.width = picture.width, .height = picture.height, .rgb = {}};
    shown.rgb.reserve(3 * picture.pixels.size());
    for (const Imath::C3f& pixel : picture.pixels)
        for (int c = 0; c < 3; ++c) shown.rgb.push_back(srgb8_from_linear(static_cast<float>(exposure * pixel[c])));
    return shown;
}

ShownPicture shown_map(int width, int height, std::span<const double> values, double top) {
    ShownPicture shown{.width = width, .height = height, .rgb = {}};
    shown.rgb.reserve(3 * values.size());
    for (const double value : values) {
        if (value < 0)
            shown.rgb.insert(shown.rgb.end(), 3, no_value);
        else
            for (const std::uint8_t c : error_color(value / top)) shown.rgb.push_back(c);
    }
    return shown;
}

ShownPicture shown_scale() {
    constexpr int steps = 256;
    std::vector<double> values;
    values.reserve(steps);
    for (int i = 0; i < steps; ++i) values.push_back(i);
    return shown_map(steps, 1, values, steps - 1);
}

double scale_end(double value) {
    if (!(value > 0)) return 1;
    const double power = std::pow(10, std::floor(std::log10(value)));
    for (const double step : {1.0, 2.0, 5.0})
        if (value <= step * power) return step * power;
    return 10 * power;
}

std::string png_bytes(const ShownPicture& picture) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(picture.width);
    image.height = static_cast<png_uint_32>(picture.height);
    image.format = PNG_FORMAT_RGB;
    png_alloc_size_t size = 0;
    if (png_image_write_get_memory_size(image, size, 0, picture.rgb.data(), 0, nullptr) == 0)
        throw std::runtime_error(image.message);
    std::string bytes(size, '\0');
    if (png_image_write_to_memory(&image, bytes.data(), &size, 0, picture.rgb.data(), 0, nullptr) == 0)
        throw std::runtime_error(image.message);
    bytes.resize(size);
    return bytes;
}

std::string png_data_uri(const ShownPicture& picture) {
    return "data:image/png;base64," + base64(png_bytes(picture));
}

}  // namespace vmap
