// SPDX-License-Identifier: GPL-3.0-or-later
#include <decode_image.h>

#include "test_images.h"

#include <content_error.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <png.h>

#include <span>
#include <string>
#include <vector>

namespace vmap::test {
namespace {

using testing::ElementsAre;

std::span<const std::byte> bytes_of(const std::string& file) {
    return std::as_bytes(std::span(file));
}

std::vector<std::uint8_t> decode(const std::string& file) {
    return decode_image(bytes_of(file), read_image_header(bytes_of(file))).rgba;
}

TEST(DecodeImage, ColoursBecomeFourBytesAPixel) {
    EXPECT_THAT(decode(png_file(2, 1, PNG_COLOR_TYPE_RGB, 8, {1, 2, 3, 4, 5, 6})),
                ElementsAre(1, 2, 3, 255, 4, 5, 6, 255));
    EXPECT_THAT(decode(png_file(1, 1, PNG_COLOR_TYPE_RGBA, 8, {1, 2, 3, 4})), ElementsAre(1, 2, 3, 4));
}

TEST(DecodeImage, GreyAndAlpha) {
    EXPECT_THAT(decode(png_file(1, 1, PNG_COLOR_TYPE_GRAY, 8, {7})), ElementsAre(7, 7, 7, 255));
    EXPECT_THAT(decode(png_file(1, 1, PNG_COLOR_TYPE_GRAY_ALPHA, 8, {7, 9})), ElementsAre(7, 7, 7, 9));
    EXPECT_THAT(decode(png_file(2, 1, PNG_COLOR_TYPE_GRAY, 1, {0x40})), ElementsAre(0, 0, 0, 255, 255, 255, 255, 255));
}

TEST(DecodeImage, PaletteWithTransparency) {
    EXPECT_THAT(decode(png_file(2, 1, PNG_COLOR_TYPE_PALETTE, 8, {2, 1})), ElementsAre(0, 255, 0, 128, 255, 0, 0, 255));
}

TEST(DecodeImage, SixteenBitsAreRounded) {
    // 0x1281 / 257 = 18.4..., 0x12FF / 257 = 18.9...
    EXPECT_THAT(decode(png_file(1, 1, PNG_COLOR_TYPE_RGB, 16, {0x12, 0x81, 0x12, 0xFF, 0xFF, 0xFF})),
                ElementsAre(18, 19, 255, 255));
}

TEST(DecodeImage, InterlacedRowsEndInOrder) {
    std::vector<std::uint8_t> samples(static_cast<std::size_t>(9 * 7));
    for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = static_cast<std::uint8_t>(3 * i);
    EXPECT_EQ(decode(png_file(9, 7, PNG_COLOR_TYPE_GRAY, 8, samples, true)),
              decode(png_file(9, 7, PNG_COLOR_TYPE_GRAY, 8, samples)));
}

TEST(DecodeImage, JpegKeepsFlatColours) {
    std::vector<std::uint8_t> rgb;
    for (int i = 0; i < 16 * 16; ++i) rgb.insert(rgb.end(), {200, 100, 50});
    const std::vector<std::uint8_t> rgba = decode(jpeg_file(16, 16, rgb));
    ASSERT_EQ(rgba.size(), 16 * 16 * 4);
    EXPECT_NEAR(rgba[0], 200, 2);
    EXPECT_NEAR(rgba[1], 100, 2);
    EXPECT_NEAR(rgba[2], 50, 2);
    EXPECT_EQ(rgba[3], 255);
}

TEST(DecodeImage, CutOffFilesAreDamagedAtEveryLength) {
    for (const std::string& file : {png_file(5, 4, PNG_COLOR_TYPE_GRAY, 8, std::vector<std::uint8_t>(20, 9)),
                                    jpeg_file(8, 8, std::vector<std::uint8_t>(8 * 8 * 3, 9))}) {
        const bool png = file[1] == 'P';
        // The last chunk of a PNG and the end mark of a JPEG hold nothing that the picture needs.
        const std::size_t needed = file.size() - (png ? 12 : 2);
        for (std::size_t length = 3; length < needed; ++length) {
            const std::string cut = file.substr(0, length);
            EXPECT_ANY_THROW(decode(cut)) << (png ? "PNG " : "JPEG ") << length;
        }
    }
}

TEST(DecodeImage, OtherFormatsAreNamed) {
    for (const auto& [start, name] : {std::pair<std::string, std::string>{"GIF89a", "GIF"},
                                      {std::string("RIFF\1\0\0\0WEBPVP8 ", 16), "WebP"},
                                      {std::string("\xABKTX 20\xBB\r\n\x1A\n", 12), "KTX2"},
                                      {"hello", "unknown"},
                                      {"", "unknown"}}) {
        try {
            static_cast<void>(read_image_header(bytes_of(start)));
            ADD_FAILURE() << name;
        } catch (const UnsupportedContent& error) {
            EXPECT_THAT(error.what(), testing::HasSubstr(name));
        }
    }
}

TEST(DecodeImage, SizeIsKnownBeforeAnythingIsDecoded) {
    std::string file = png_file(1, 1, PNG_COLOR_TYPE_GRAY, 8, {7});
    file.replace(16, 8, std::string("\0\0\x2E\xE0\0\0\x2E\xE0", 8));  // 12000 x 12000
    EXPECT_THROW(static_cast<void>(read_image_header(bytes_of(file))), UnsupportedContent);
    file.replace(16, 4, std::string("\0\0\0\0", 4));
    EXPECT_THROW(static_cast<void>(read_image_header(bytes_of(file))), BrokenContent);
}

TEST(DecodeImage, MorePixelsThanTheHeaderSaysAreRefused) {
    const std::vector<std::uint8_t> samples(64 * 64, 1);
    const std::string small = png_file(4, 4, PNG_COLOR_TYPE_GRAY, 8, samples);
    const std::string large = png_file(64, 64, PNG_COLOR_TYPE_GRAY, 8, samples);
    const std::string mixed = small.substr(0, 33) + large.substr(33);
    // Too many rows are ignored by libpng; what counts is that the picture has the size of its header.
    try {
        EXPECT_EQ(decode(mixed).size(), 4 * 16);
    } catch (const BrokenContent&) {
        SUCCEED();
    }
}

}  // namespace
}  // namespace vmap::test
