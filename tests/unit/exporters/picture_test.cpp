// SPDX-License-Identifier: GPL-3.0-or-later
#include "output_folder.h"

#include <vmap/error.h>
#include <vmap/exporters/exr.h>
#include <vmap/exporters/png.h>

#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStringAttribute.h>
#include <gtest/gtest.h>
#include <png.h>

#include <string>
#include <vector>

namespace vmap {
namespace {

/// Three columns and two rows, brighter from pixel to pixel; the last one is far above 1.
Picture small_picture() {
    Picture picture;
    picture.width = 3;
    picture.height = 2;
    for (int i = 0; i < 6; ++i) picture.pixels.emplace_back(0.1F * static_cast<float>(i), 0.5F, 0.0F);
    picture.pixels.back() = {1e4F, 1e5F, -1.0F};
    return picture;
}

class PictureFile : public OutputFolder {};

std::vector<float> read_channel(const std::string& path, const char* name) {
    Imf::InputFile file(path.c_str());
    const Imath::Box2i window = file.header().dataWindow();
    const auto width = static_cast<std::size_t>(window.max.x) + 1;
    std::vector<float> values(width * (static_cast<std::size_t>(window.max.y) + 1));
    Imf::FrameBuffer buffer;
    buffer.insert(name,
                  Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), sizeof(float), sizeof(float) * width));
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
    return values;
}

TEST_F(PictureFile, ExrHoldsEveryValueExactly) {
    const Picture picture = small_picture();
    FileWriter file(path("picture.exr"));
    write_exr(file, picture, {.exposure = 3, .source = "room.glb"});
    file.commit();

    const char* names[] = {"R", "G", "B"};
    for (int channel = 0; channel < 3; ++channel) {
        const std::vector<float> values = read_channel(path("picture.exr"), names[channel]);
        ASSERT_EQ(values.size(), 6U);
        for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(values[i], picture.pixels[i][channel]);
    }
    const Imf::InputFile read(path("picture.exr").c_str());
    EXPECT_EQ(read.header().typedAttribute<Imf::StringAttribute>("source").value(), "room.glb");
    EXPECT_EQ(read.header().channels().findChannel("A"), nullptr);
}

TEST_F(PictureFile, ExrHasAlphaWhereThePictureHas) {
    Picture picture = small_picture();
    picture.alpha = {0, 0.25F, 0.5F, 0.75F, 1, 1};
    FileWriter file(path("picture.exr"));
    write_exr(file, picture, {});
    file.commit();
    EXPECT_EQ(read_channel(path("picture.exr"), "A"), picture.alpha);
}

TEST_F(PictureFile, PngIsSrgbOfExposedRadiance) {
    FileWriter file(path("picture.png"));
    write_png(file, small_picture(), {.exposure = 2, .source = ""});
    file.commit();

    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    ASSERT_NE(png_image_begin_read_from_file(&image, path("picture.png").c_str()), 0);
    EXPECT_EQ(image.width, 3U);
    EXPECT_EQ(image.height, 2U);
    EXPECT_EQ(image.format & PNG_FORMAT_FLAG_ALPHA, 0U);
    image.format = PNG_FORMAT_RGB;
    std::vector<std::uint8_t> bytes(PNG_IMAGE_SIZE(image));
    ASSERT_NE(png_image_finish_read(&image, nullptr, bytes.data(), 0, nullptr), 0);
    // IEC 61966-2-1 of 0, 0.2, 0.4: 0, 124, 170; of 1: 255.
    EXPECT_EQ(bytes[0], 0);
    EXPECT_EQ(bytes[1], 255);
    EXPECT_EQ(bytes[3], 124);
    EXPECT_EQ(bytes[6], 170);
    EXPECT_EQ(bytes[15], 255);
    EXPECT_EQ(bytes[17], 0);
}

TEST_F(PictureFile, NoPixelsIsAUsageError) {
    FileWriter file(path("picture.exr"));
    EXPECT_THROW(write_exr(file, {}, {}), UsageError);
    EXPECT_THROW(write_png(file, {}, {}), UsageError);
}

}  // namespace
}  // namespace vmap
