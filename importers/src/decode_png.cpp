// SPDX-License-Identifier: GPL-3.0-or-later
#include "decode_png.h"

#include "content_error.h"

#include <png.h>

#include <array>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

namespace vmap {
namespace {

constexpr std::size_t signature_size = 8;
constexpr std::size_t header_end = 33;  // signature, length, "IHDR", 13 bytes, checksum

/// The file while libpng reads it, and its complaint.
struct Source {
    std::span<const std::byte> rest;
    std::array<char, 100> message{};
};

void read_bytes(png_structp png, png_bytep out, std::size_t count) {
    auto& source = *static_cast<Source*>(png_get_io_ptr(png));
    if (count > source.rest.size()) png_error(png, "it ends too early");
    std::memcpy(out, source.rest.data(), count);
    source.rest = source.rest.subspan(count);
}

void keep_error(png_structp png, png_const_charp message) {
    auto& source = *static_cast<Source*>(png_get_error_ptr(png));
    std::snprintf(source.message.data(), source.message.size(), "%s", message);
    png_longjmp(png, 1);
}

void ignore_warning(png_structp /*png*/, png_const_charp /*message*/) {}

/// libpng leaves by longjmp: nothing in here may need a destructor. Returns false when it did.
bool decode_rows(png_structp png, png_infop info, const Image& image, png_bytepp rows) {
    if (setjmp(png_jmpbuf(png)) != 0) return false;  // NOLINT(bugprone-*,modernize-*): the library's own way
    png_set_user_limits(png, largest_image_side, largest_image_side);
    png_read_info(png, info);
    if (png_get_image_width(png, info) != static_cast<png_uint_32>(image.width) ||
        png_get_image_height(png, info) != static_cast<png_uint_32>(image.height))
        png_error(png, "it has two headers");
    png_set_expand(png);
    png_set_scale_16(png);
    png_set_gray_to_rgb(png);
    png_set_add_alpha(png, 0xFF, PNG_FILLER_AFTER);
    png_set_interlace_handling(png);
    png_read_update_info(png, info);
    if (png_get_rowbytes(png, info) != 4 * static_cast<std::size_t>(image.width))
        png_error(png, "its pixels are of an unknown form");
    png_read_image(png, rows);
    return true;
}

int big_endian(std::span<const std::byte> file, std::size_t offset) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8U | std::to_integer<std::uint32_t>(file[offset + i]);
    return static_cast<int>(std::min(value, 0x7FFFFFFFU));
}

}  // namespace

ImageHeader read_png_header(std::span<const std::byte> file) {
    if (file.size() < header_end || std::memcmp(file.data() + signature_size + 4, "IHDR", 4) != 0)
        throw BrokenContent("it is a PNG without a header");
    return {ImageFormat::png, big_endian(file, signature_size + 8), big_endian(file, signature_size + 12)};
}

void decode_png(std::span<const std::byte> file, Image& image) {
    std::vector<png_bytep> rows(static_cast<std::size_t>(image.height));
    for (std::size_t y = 0; y < rows.size(); ++y)
        rows[y] = image.rgba.data() + 4 * static_cast<std::size_t>(image.width) * y;

    Source source{file, {}};
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &source, keep_error, ignore_warning);
    png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
    bool done = false;
    if (info != nullptr) {
        png_set_read_fn(png, &source, read_bytes);
        done = decode_rows(png, info, image, rows.data());
    }
    png_destroy_read_struct(&png, &info, nullptr);
    if (!done) throw BrokenContent(std::string("it is a damaged PNG: ") + source.message.data());
}

}  // namespace vmap
