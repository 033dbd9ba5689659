// SPDX-License-Identifier: GPL-3.0-or-later
#include "png_image.h"

#include <vmap/error.h>
#include <vmap/printable.h>

#include <png.h>

#include <csetjmp>
#include <exception>
#include <string>

namespace vmap {
namespace {

/// What the callbacks of one file share. libpng is C: an exception must not pass through it, so it is kept here while
/// libpng jumps out.
struct Output {
    FileWriter& file;
    std::exception_ptr failure;
    std::string message;
};

void write_bytes(png_structp png, png_bytep data, png_size_t size) {
    auto& output = *static_cast<Output*>(png_get_io_ptr(png));
    try {
        output.file.write(data, size);
        return;
    } catch (...) {
        output.failure = std::current_exception();
    }
    png_error(png, "write");
}

void flush_bytes(png_structp /*png*/) {}

[[noreturn]] void on_error(png_structp png, png_const_charp message) {
    auto& output = *static_cast<Output*>(png_get_error_ptr(png));
    if (!output.failure) output.message = message;
    png_longjmp(png, 1);
}

void on_warning(png_structp /*png*/, png_const_charp /*message*/) {}

/// The part that libpng may jump out of: nothing in here needs a destructor. Returns false on failure.
bool encode(png_structp png, png_infop info, const PngImage& image, png_text* texts) {
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    const int color_type = image.channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB;
    png_set_IHDR(png, info, static_cast<png_uint_32>(image.width), static_cast<png_uint_32>(image.height),
                 image.bits_per_sample, color_type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_RELATIVE);
    png_set_text(png, info, texts, static_cast<int>(image.texts.size()));
    png_write_info(png, info);
    const std::size_t row_size =
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels * image.bits_per_sample / 8);
    for (int y = 0; y < image.height; ++y)
        png_write_row(png, image.bytes.data() + static_cast<std::size_t>(y) * row_size);
    png_write_end(png, info);
    return true;
}

}  // namespace

void write_png_image(FileWriter& file, const PngImage& image) {
    std::vector<png_text> texts;
    for (const auto& [key, value] : image.texts) {
        png_text text{};
        text.compression = PNG_ITXT_COMPRESSION_NONE;  // UTF-8
        text.key = const_cast<char*>(key.c_str());     // only read
        text.text = const_cast<char*>(value.c_str());
        texts.push_back(text);
    }

    Output output{file, {}, {}};
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &output, on_error, on_warning);
    png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
    bool good = false;
    if (info != nullptr) {
        png_set_write_fn(png, &output, write_bytes, flush_bytes);
        png_set_compression_level(png, 4);  // half the time of the default for 2 % more bytes
        good = encode(png, info, image, texts.data());
    }
    png_destroy_write_struct(&png, &info);
    if (output.failure) std::rethrow_exception(output.failure);
    if (!good) throw FileError(printable(file.path()) + ": cannot write the PNG file: " + output.message);
}

}  // namespace vmap
