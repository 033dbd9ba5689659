// SPDX-License-Identifier: GPL-3.0-or-later
#include "png_data.h"

#include <vmap/exporters/base64.h>

#include <png.h>

#include <stdexcept>

namespace vmap {

std::string png_data_uri(int width, int height, std::span<const std::uint8_t> rgb) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(width);
    image.height = static_cast<png_uint_32>(height);
    image.format = PNG_FORMAT_RGB;
    png_alloc_size_t size = 0;
    std::string bytes;
    if (png_image_write_get_memory_size(image, size, 0, rgb.data(), 0, nullptr) == 0)
        throw std::runtime_error(image.message);
    bytes.resize(size);
    if (png_image_write_to_memory(&image, bytes.data(), &size, 0, rgb.data(), 0, nullptr) == 0)
        throw std::runtime_error(image.message);
    bytes.resize(size);
    return "data:image/png;base64," + base64(bytes);
}

}  // namespace vmap
