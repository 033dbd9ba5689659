// SPDX-License-Identifier: GPL-3.0-or-later
#include "test_images.h"

#include <png.h>
#include <turbojpeg.h>

#include <array>
#include <stdexcept>

namespace vmap::test {
namespace {

void append(png_structp png, png_bytep bytes, std::size_t size) {
    static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(bytes), size);
}

void set_palette(png_structp png, png_infop info) {
    constexpr std::array<png_color, 3> palette{{{0, 0, 0}, {255, 0, 0}, {0, 255, 0}}};
    constexpr std::array<png_byte, 3> alpha{255, 255, 128};
    png_set_PLTE(png, info, palette.data(), palette.size());
    png_set_tRNS(png, info, alpha.data(), alpha.size(), nullptr);
}

}  // namespace

std::string png_file(int width, int height, int color_type, int bit_depth, const std::vector<std::uint8_t>& samples,
                     bool interlaced) {
    std::string file;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(png, &file, append, nullptr);
    png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), bit_depth, color_type,
                 interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    if (color_type == PNG_COLOR_TYPE_PALETTE) set_palette(png, info);
    png_write_info(png, info);
    const std::size_t row_size = png_get_rowbytes(png, info);
    std::vector<std::uint8_t> copy = samples;
    std::vector<png_bytep> rows;
    rows.reserve(static_cast<std::size_t>(height));
    for (int y = 0; y < height; ++y) rows.push_back(copy.data() + static_cast<std::size_t>(y) * row_size);
    png_write_image(png, rows.data());
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return file;
}

std::string jpeg_file(int width, int height, const std::vector<std::uint8_t>& rgb) {
    tjhandle compressor = tjInitCompress();
    unsigned char* bytes = nullptr;
    unsigned long size = 0;
    const int failed = tjCompress2(compressor, rgb.data(), width, 0, height, TJPF_RGB, &bytes, &size, TJSAMP_444, 100,
                                   TJFLAG_ACCURATEDCT);
    std::string file(reinterpret_cast<const char*>(bytes), size);
    tjFree(bytes);
    tjDestroy(compressor);
    if (failed != 0) throw std::runtime_error("cannot make a JPEG for the test");
    return file;
}

}  // namespace vmap::test
