// SPDX-License-Identifier: GPL-3.0-or-later
#include "decode_image.h"

#include "content_error.h"
#include "decode_jpeg.h"
#include "decode_png.h"
#include "file_bytes.h"

#include <fmt/format.h>

#include <string_view>

namespace vmap {
namespace {

/// What else may stand in a scene file, so that the message can name it.
std::string_view other_format(std::string_view text) {
    if (text.starts_with("\xABKTX 20\xBB")) return "KTX2";
    if (text.starts_with("RIFF") && text.substr(0, 12).ends_with("WEBP")) return "WebP";
    if (text.starts_with("GIF8")) return "GIF";
    if (text.starts_with("DDS ")) return "DDS";
    if (text.substr(0, 12).ends_with("ftypavif")) return "AVIF";
    return "unknown";
}

}  // namespace

ImageHeader read_image_header(std::span<const std::byte> file) {
    using namespace std::string_view_literals;
    const std::string_view text = as_text(file);
    ImageHeader header;
    if (text.starts_with("\x89PNG\r\n\x1a\n"sv))
        header = read_png_header(file);
    else if (text.starts_with("\xFF\xD8\xFF"sv))
        header = read_jpeg_header(file);
    else
        throw UnsupportedContent(fmt::format("its format is {}, expected PNG or JPEG", other_format(text)));

    if (header.width <= 0 || header.height <= 0) throw BrokenContent("it has no pixels");
    if (header.width > largest_image_side || header.height > largest_image_side || header.pixels() > most_image_pixels)
        throw UnsupportedContent(fmt::format("it has {} x {} pixels, more than the {} that are read", header.width,
                                             header.height, most_image_pixels));
    return header;
}

Image decode_image(std::span<const std::byte> file, const ImageHeader& header) {
    Image image;
    image.width = header.width;
    image.height = header.height;
    image.rgba.resize(4 * header.pixels());
    if (header.format == ImageFormat::png)
        decode_png(file, image);
    else
        decode_jpeg(file, image);
    return image;
}

}  // namespace vmap
