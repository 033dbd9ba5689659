// SPDX-License-Identifier: GPL-3.0-or-later
#include <vmap/compare/picture_file.h>
#include <vmap/error.h>
#include <vmap/printable.h>

#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <png.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace vmap {
namespace {

/// Pixels that a picture may have: 1 GiB of colours. Files are not trusted.
constexpr std::int64_t most_pixels = std::int64_t{1} << 26;

enum class PictureFormat { exr, png, other };

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& what) {
    throw FileError(printable(file.string()) + ": " + what);
}

PictureFormat format_of(const std::filesystem::path& file) {
    if (std::filesystem::is_directory(file)) fail(file, "is a folder, expected a picture or a cloud");
    std::ifstream stream(file, std::ios::binary);
    if (!stream) fail(file, "cannot open: " + std::generic_category().message(errno));
    std::array<char, 8> start{};
    stream.read(start.data(), start.size());
    const std::string_view bytes(start.data(), static_cast<std::size_t>(stream.gcount()));
    if (bytes.empty()) fail(file, "is empty, expected a picture or a cloud");
    if (bytes.starts_with("\x76\x2f\x31\x01")) return PictureFormat::exr;
    if (bytes.starts_with("\x89PNG\r\n\x1a\n")) return PictureFormat::png;
    return PictureFormat::other;
}

void check_size(const std::filesystem::path& file, std::int64_t width, std::int64_t height) {
    if (width <= 0 || height <= 0) fail(file, "has no pixels");
    if (width > most_pixels / height)
        fail(file, std::to_string(width) + " x " + std::to_string(height) + " pixels are more than " +
                       std::to_string(most_pixels));
}

Picture read_exr(const std::filesystem::path& file) {
    Imf::InputFile input(file.c_str());
    const Imath::Box2i window = input.header().dataWindow();
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
    const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
    check_size(file, width, height);
    const Imf::ChannelList& channels = input.header().channels();
    const bool colors = channels.findChannel("R") != nullptr;
    const std::array<const char*, 3> names =
        colors ? std::array<const char*, 3>{"R", "G", "B"} : std::array<const char*, 3>{"Y", "Y", "Y"};
    for (const char* name : names)
        if (channels.findChannel(name) == nullptr)
            throw UnsupportedInput(printable(file.string()) + ": no channel " + name +
                                   ", expected R, G and B, or Y alone");

    Picture picture;
    picture.width = static_cast<int>(width);
    picture.height = static_cast<int>(height);
    picture.pixels.resize(static_cast<std::size_t>(width * height));
    constexpr auto step = static_cast<std::int64_t>(sizeof(Imath::C3f));
    for (int c = 0; c < (colors ? 3 : 1); ++c) {
        Imf::FrameBuffer buffer;
        char* first = reinterpret_cast<char*>(picture.pixels.data()) + c * static_cast<std::int64_t>(sizeof(float)) -
                      (window.min.x + window.min.y * width) * step;
        buffer.insert(names[c], Imf::Slice(Imf::FLOAT, first, step, static_cast<std::size_t>(width * step)));
        input.setFrameBuffer(buffer);
        input.readPixels(window.min.y, window.max.y);
    }
    if (!colors)
        for (Imath::C3f& pixel : picture.pixels) pixel = Imath::C3f(pixel.x, pixel.x, pixel.x);
    return picture;
}

Picture read_png(const std::filesystem::path& file) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_file(&image, file.c_str()) == 0) fail(file, image.message);
    if (std::int64_t{image.width} > most_pixels / std::int64_t{image.height}) {
        png_image_free(&image);
        check_size(file, image.width, image.height);
    }
    image.format = PNG_FORMAT_LINEAR_RGB;
    std::vector<std::uint16_t> samples(std::size_t{3} * image.width * image.height);
    const png_color black{0, 0, 0};
    if (png_image_finish_read(&image, &black, samples.data(), 0, nullptr) == 0) fail(file, image.message);

    Picture picture;
    picture.width = static_cast<int>(image.width);
    picture.height = static_cast<int>(image.height);
    for (std::size_t i = 0; i < samples.size(); i += 3)
        picture.pixels.push_back(Imath::C3f(samples[i], samples[i + 1], samples[i + 2]) / 65535.0F);
    return picture;
}

void check_finite(const std::filesystem::path& file, const Picture& picture) {
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c)
            if (!std::isfinite(picture.pixels[i][c])) {
                const auto width = static_cast<std::size_t>(picture.width);
                fail(file, "pixel " + std::to_string(i % width) + ", " + std::to_string(i / width) + " is not finite");
            }
}

}  // namespace

Picture read_picture(const std::filesystem::path& file) {
    Picture picture;
    switch (format_of(file)) {
        case PictureFormat::exr:
            try {
                picture = read_exr(file);
            } catch (const Error&) {
                throw;
            } catch (const std::bad_alloc&) {
                throw;
            } catch (const std::exception& error) {
                fail(file, printable(error.what()));
            }
            break;
        case PictureFormat::png:
            picture = read_png(file);
            break;
        case PictureFormat::other:
            throw UnsupportedInput(printable(file.string()) + ": neither an EXR nor a PNG file");
    }
    check_finite(file, picture);
    return picture;
}

bool is_picture(const std::filesystem::path& file) {
    return format_of(file) != PictureFormat::other;
}

}  // namespace vmap
