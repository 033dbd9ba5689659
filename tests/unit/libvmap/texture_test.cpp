// SPDX-License-Identifier: GPL-3.0-or-later
#include <vmap/texture.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace vmap {
namespace {

using Imath::C4f;
using Imath::V2d;

using Pixel = std::array<std::uint8_t, 4>;

Image image_of(int width, int height, const std::vector<Pixel>& pixels) {
    Image image{.name = "test", .width = width, .height = height, .rgba = {}};
    for (const Pixel& pixel : pixels) image.rgba.insert(image.rgba.end(), pixel.begin(), pixel.end());
    return image;
}

Image checkerboard(int size) {
    std::vector<Pixel> pixels;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const auto value = static_cast<std::uint8_t>((x + y) % 2 == 0 ? 255 : 0);
            pixels.push_back({value, value, value, 255});
        }
    return image_of(size, size, pixels);
}

/// A row of four grey texels, 0 to 3 tenths of the way in linear numbers.
Image ramp() {
    return image_of(4, 1, {{0, 0, 0, 255}, {51, 51, 51, 255}, {102, 102, 102, 255}, {153, 153, 153, 255}});
}

TextureFootprint square(const V2d& center, double width) {
    return {center, {width, 0}, {0, width}};
}

TEST(LinearFromSrgb, KnownValuesOfTheStandard) {
    EXPECT_EQ(linear_from_srgb8(0), 0.0F);
    EXPECT_EQ(linear_from_srgb8(255), 1.0F);
    EXPECT_NEAR(linear_from_srgb8(188), 0.5029, 1e-4);
    EXPECT_NEAR(linear_from_srgb8(10), 10 / 255.0 / 12.92, 1e-7);
}

TEST(TexturePyramid, InterpolatesBetweenTexelCentres) {
    const Image image = ramp();
    const TexturePyramid pyramid(image, TexelMeaning::data);
    EXPECT_NEAR(pyramid.at({}, {0.375, 0.5}).r, 0.2, 1e-6);
    EXPECT_NEAR(pyramid.at({}, {0.5, 0.5}).r, 0.3, 1e-6);
}

TEST(TexturePyramid, NearestTakesTheTexelItself) {
    const Image image = ramp();
    const TexturePyramid pyramid(image, TexelMeaning::data);
    TextureView view;
    view.nearest = true;
    EXPECT_NEAR(pyramid.at(view, {0.26, 0.5}).r, 0.2, 1e-6);
    EXPECT_NEAR(pyramid.at(view, {0.49, 0.5}).r, 0.2, 1e-6);
    EXPECT_NEAR(pyramid.at(view, {-0.01, 0.5}).r, 0.6, 1e-6);
}

TEST(TexturePyramid, WrapModesDifferOutsideTheImage) {
    const Image image = ramp();
    const TexturePyramid pyramid(image, TexelMeaning::data);
    TextureView view;
    view.wrap_u = WrapMode::repeat;
    EXPECT_NEAR(pyramid.at(view, {1.125, 0.5}).r, 0.0, 1e-6);
    EXPECT_NEAR(pyramid.at(view, {1.0, 0.5}).r, 0.3, 1e-6) << "halfway between the last and the first texel";
    view.wrap_u = WrapMode::mirrored_repeat;
    EXPECT_NEAR(pyramid.at(view, {1.125, 0.5}).r, 0.6, 1e-6);
    EXPECT_NEAR(pyramid.at(view, {-0.375, 0.5}).r, 0.2, 1e-6);
    view.wrap_u = WrapMode::clamp_to_edge;
    EXPECT_NEAR(pyramid.at(view, {7.0, 0.5}).r, 0.6, 1e-6);
    EXPECT_NEAR(pyramid.at(view, {-7.0, 0.5}).r, 0.0, 1e-6);
}

TEST(TexturePyramid, AppliesTheTransformOfTheView) {
    const Image image = ramp();
    const TexturePyramid pyramid(image, TexelMeaning::data);
    TextureView view;
    view.image_from_texcoord = {{{0.5, 0, 0.25}, {0, 1, 0}}};
    EXPECT_NEAR(pyramid.at(view, {0.25, 0.5}).r, 0.2, 1e-6);
}

TEST(TexturePyramid, AveragesInLinearLight) {
    const Image image = checkerboard(64);
    const TexturePyramid pyramid(image, TexelMeaning::color);
    EXPECT_NEAR(pyramid.average({}, square({0.5, 0.5}, 0.25)).r, 0.5, 1e-3);
    EXPECT_NEAR(pyramid.average({}, square({0.3, 0.7}, 10)).r, 0.5, 1e-3);
}

TEST(TexturePyramid, MeanOfTheImageSurvivesOddSizes) {
    std::mt19937 random(7);
    for (const auto& [width, height] : {std::pair(1, 1), {3, 5}, {7, 1}, {37, 23}, {129, 2}}) {
        std::vector<Pixel> pixels(static_cast<std::size_t>(width) * height);
        double mean = 0;
        for (Pixel& pixel : pixels) {
            pixel = {static_cast<std::uint8_t>(random() % 256), 0, 0, 255};
            mean += pixel[0] / 255.0 / static_cast<double>(pixels.size());
        }
        const Image image = image_of(width, height, pixels);
        const TexturePyramid pyramid(image, TexelMeaning::data);
        EXPECT_NEAR(pyramid.average({}, square({0.5, 0.5}, 100)).r, mean, 1e-3) << width << " x " << height;
    }
}

TEST(TexturePyramid, LongFootprintDoesNotBlurAcross) {
    // Stripes that run along v: a footprint that is long in v must keep them apart.
    std::vector<Pixel> pixels;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const auto value = static_cast<std::uint8_t>(x / 8 % 2 == 0 ? 255 : 0);
            pixels.push_back({value, value, value, 255});
        }
    const Image image = image_of(64, 64, pixels);
    const TexturePyramid pyramid(image, TexelMeaning::data);
    const V2d white(4.0 / 64, 0.5);
    EXPECT_GT(pyramid.average({}, {white, {1.0 / 64, 0}, {0, 8.0 / 64}}).r, 0.95);
    EXPECT_LT(pyramid.average({}, square(white, 0.5)).r, 0.8);
}

TEST(TexturePyramid, CutAwayTexelsDoNotDarkenTheRest) {
    std::vector<Pixel> pixels;
    pixels.reserve(16 * 16);
    for (int i = 0; i < 16 * 16; ++i) pixels.push_back(i % 2 == 0 ? Pixel{255, 255, 255, 255} : Pixel{0, 0, 0, 0});
    const Image image = image_of(16, 16, pixels);
    EXPECT_NEAR(TexturePyramid(image, TexelMeaning::cutout).average({}, square({0.5, 0.5}, 1)).r, 1.0, 1e-3);
    EXPECT_NEAR(TexturePyramid(image, TexelMeaning::color).average({}, square({0.5, 0.5}, 1)).r, 0.5, 1e-3);
}

TEST(TexturePyramid, HugeCoordinatesStayInsideTheImage) {
    const Image image = checkerboard(8);
    const TexturePyramid pyramid(image, TexelMeaning::data);
    for (const WrapMode wrap : {WrapMode::repeat, WrapMode::mirrored_repeat, WrapMode::clamp_to_edge}) {
        TextureView view;
        view.wrap_u = view.wrap_v = wrap;
        for (const double where : {-1e30, -1e9 - 0.3, 1e9 + 0.7, 1e30}) {
            const C4f value = pyramid.average(view, square({where, -where}, 1e20));
            EXPECT_GE(value.r, 0.0F);
            EXPECT_LE(value.r, 1.0F);
        }
    }
}

}  // namespace
}  // namespace vmap
