// SPDX-License-Identifier: GPL-3.0-or-later
#include "decode_jpeg.h"

#include "content_error.h"

#include <turbojpeg.h>

#include <memory>
#include <string>

namespace vmap {
namespace {

struct Destroy {
    void operator()(void* handle) const { tjDestroy(handle); }
};
using Decompressor = std::unique_ptr<void, Destroy>;

Decompressor make_decompressor() {
    Decompressor decompressor(tjInitDecompress());
    if (decompressor == nullptr) throw std::bad_alloc();
    return decompressor;
}

const unsigned char* bytes_of(std::span<const std::byte> file) {
    return reinterpret_cast<const unsigned char*>(file.data());
}

[[noreturn]] void fail(const Decompressor& decompressor) {
    throw BrokenContent(std::string("it is a damaged JPEG: ") + tjGetErrorStr2(decompressor.get()));
}

ImageHeader read_header(const Decompressor& decompressor, std::span<const std::byte> file) {
    ImageHeader header{ImageFormat::jpeg, 0, 0};
    int subsampling = 0;
    int color_space = 0;
    if (tjDecompressHeader3(decompressor.get(), bytes_of(file), file.size(), &header.width, &header.height,
                            &subsampling, &color_space) != 0)
        fail(decompressor);
    if (color_space == TJCS_CMYK || color_space == TJCS_YCCK)
        throw UnsupportedContent("it is a JPEG of four inks, expected RGB or grey");
    return header;
}

}  // namespace

ImageHeader read_jpeg_header(std::span<const std::byte> file) {
    return read_header(make_decompressor(), file);
}

void decode_jpeg(std::span<const std::byte> file, Image& image) {
    const Decompressor decompressor = make_decompressor();
    // Files of very many scans take minutes to say nothing, and every warning means that the picture is not whole.
    constexpr int flags = TJFLAG_LIMITSCANS | TJFLAG_ACCURATEDCT | TJFLAG_STOPONWARNING;
    if (tjDecompress2(decompressor.get(), bytes_of(file), file.size(), image.rgba.data(), image.width, 0, image.height,
                      TJPF_RGBA, flags) != 0)
        fail(decompressor);
}

}  // namespace vmap
