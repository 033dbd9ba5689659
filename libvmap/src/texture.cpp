// SPDX-License-Identifier: Apache-2.0
#include <vmap/texture.h>

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace vmap {
namespace {

using Imath::C4f;
using Imath::V2d;
using Imath::V2i;

constexpr int max_looks = 8;

std::uint16_t encode(double linear) {
    return static_cast<std::uint16_t>(std::lround(std::sqrt(std::clamp(linear, 0.0, 1.0)) * 65535));
}

float decode(std::uint16_t coded) {
    const float root = static_cast<float>(coded) * (1.0F / 65535);
    return root * root;
}

/// Brings a coordinate into [0, 2], so that texel numbers fit an int whatever the file says.
double reduce(WrapMode wrap, double coordinate) {
    switch (wrap) {
        case WrapMode::repeat:
            return coordinate - std::floor(coordinate);
        case WrapMode::mirrored_repeat:
            return coordinate - 2 * std::floor(coordinate / 2);
        case WrapMode::clamp_to_edge:
            break;
    }
    return std::clamp(coordinate, 0.0, 1.0);
}

/// Texel number inside [0, size) for one at most a period outside of it.
int wrap_texel(WrapMode wrap, int texel, int size) {
    switch (wrap) {
        case WrapMode::repeat:
            return (texel % size + size) % size;
        case WrapMode::mirrored_repeat: {
            const int period = 2 * size;
            const int folded = (texel % period + period) % period;
            return folded < size ? folded : period - 1 - folded;
        }
        case WrapMode::clamp_to_edge:
            break;
    }
    return std::clamp(texel, 0, size - 1);
}

V2d transformed(const TextureView& view, const V2d& texcoord) {
    const auto& m = view.image_from_texcoord;
    return {m[0][0] * texcoord.x + m[0][1] * texcoord.y + m[0][2],
            m[1][0] * texcoord.x + m[1][1] * texcoord.y + m[1][2]};
}

/// The texels of a larger row that one texel of a smaller row covers, with their shares; at most three.
struct Cover {
    int first = 0;
    std::array<double, 3> shares{0, 0, 0};
};

Cover cover_of(int texel, int small, int large) {
    const double ratio = static_cast<double>(large) / small;
    const double begin = texel * ratio;
    const double end = begin + ratio;
    Cover cover{.first = static_cast<int>(begin)};
    for (int i = 0; i < 3; ++i) {
        const double overlap = std::min(end, cover.first + i + 1.0) - std::max(begin, cover.first + i + 0.0);
        cover.shares[i] = std::max(overlap, 0.0) / ratio;
    }
    return cover;
}

/// A footprint in texels: its longer axis, and the lengths of both axes of the ellipse that it spans.
struct Ellipse {
    V2d long_axis;
    double long_length = 0;
    double short_length = 0;
};

/// Singular values of the matrix with these columns, and the direction of the larger one.
Ellipse ellipse_of(const V2d& a, const V2d& b) {
    const double xx = a.x * a.x + b.x * b.x;
    const double xy = a.x * a.y + b.x * b.y;
    const double yy = a.y * a.y + b.y * b.y;
    const double mean = (xx + yy) / 2;
    const double spread = std::hypot((xx - yy) / 2, xy);
    const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
    Ellipse ellipse;
    ellipse.long_length = std::sqrt(mean + spread);
    ellipse.short_length = std::sqrt(std::max(mean - spread, 0.0));
    ellipse.long_axis = V2d(std::cos(angle), std::sin(angle)) * ellipse.long_length;
    return ellipse;
}

}  // namespace

TexturePyramid::TexturePyramid(const Image& image, TexelMeaning meaning) : image_(&image), meaning_(meaning) {
    assert(image.width > 0 && image.height > 0);
    assert(image.rgba.size() == 4 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
    while (size_of(level_count() - 1) != V2i(1, 1)) levels_.push_back(shrink(level_count() - 1));
}

V2i TexturePyramid::size_of(int level) const {
    if (level == 0) return {image_->width, image_->height};
    return {levels_[level - 1].width, levels_[level - 1].height};
}

C4f TexturePyramid::texel(int level, int x, int y) const {
    if (level > 0) {
        const Level& coarse = levels_[level - 1];
        const CodedTexel& coded = coarse.texels[static_cast<std::size_t>(y) * coarse.width + x];
        return {decode(coded[0]), decode(coded[1]), decode(coded[2]), decode(coded[3])};
    }
    const std::uint8_t* bytes = &image_->rgba[4 * (static_cast<std::size_t>(y) * image_->width + x)];
    const float alpha = static_cast<float>(bytes[3]) / 255;
    if (meaning_ == TexelMeaning::data)
        return {static_cast<float>(bytes[0]) / 255, static_cast<float>(bytes[1]) / 255,
                static_cast<float>(bytes[2]) / 255, alpha};
    const float weight = meaning_ == TexelMeaning::cutout ? alpha : 1;
    return {linear_from_srgb8(bytes[0]) * weight, linear_from_srgb8(bytes[1]) * weight,
            linear_from_srgb8(bytes[2]) * weight, alpha};
}

TexturePyramid::Level TexturePyramid::shrink(int level) const {
    const V2i large = size_of(level);
    Level small{.width = std::max(large.x / 2, 1), .height = std::max(large.y / 2, 1), .texels = {}};
    small.texels.resize(static_cast<std::size_t>(small.width) * small.height);
    std::vector<Cover> columns(small.width);
    for (int x = 0; x < small.width; ++x) columns[x] = cover_of(x, small.width, large.x);
    tbb::parallel_for(0, small.height, [&](int y) {
        const Cover rows = cover_of(y, small.height, large.y);
        for (int x = 0; x < small.width; ++x) {
            std::array<double, 4> sum{};
            for (int j = 0; j < 3; ++j) {
                for (int i = 0; i < 3; ++i) {
                    const double share = rows.shares[j] * columns[x].shares[i];
                    if (share <= 0) continue;
                    const C4f value = texel(level, std::min(columns[x].first + i, large.x - 1),
                                            std::min(rows.first + j, large.y - 1));
                    sum[0] += share * value.r;
                    sum[1] += share * value.g;
                    sum[2] += share * value.b;
                    sum[3] += share * value.a;
                }
            }
            small.texels[static_cast<std::size_t>(y) * small.width + x] = {encode(sum[0]), encode(sum[1]),
                                                                           encode(sum[2]), encode(sum[3])};
        }
    });
    return small;
}

C4f TexturePyramid::interpolate(const TextureView& view, int level, const V2d& place) const {
    const V2i size = size_of(level);
    const double x = reduce(view.wrap_u, place.x) * size.x;
    const double y = reduce(view.wrap_v, place.y) * size.y;
    if (view.nearest && level == 0)
        return texel(level, wrap_texel(view.wrap_u, static_cast<int>(std::floor(x)), size.x),
                     wrap_texel(view.wrap_v, static_cast<int>(std::floor(y)), size.y));

    const int x0 = static_cast<int>(std::floor(x - 0.5));
    const int y0 = static_cast<int>(std::floor(y - 0.5));
    const auto s = static_cast<float>(x - 0.5 - x0);
    const auto t = static_cast<float>(y - 0.5 - y0);
    const int left = wrap_texel(view.wrap_u, x0, size.x);
    const int right = wrap_texel(view.wrap_u, x0 + 1, size.x);
    const int top = wrap_texel(view.wrap_v, y0, size.y);
    const int bottom = wrap_texel(view.wrap_v, y0 + 1, size.y);
    const C4f upper = texel(level, left, top) * (1 - s) + texel(level, right, top) * s;
    const C4f lower = texel(level, left, bottom) * (1 - s) + texel(level, right, bottom) * s;
    return upper * (1 - t) + lower * t;
}

C4f TexturePyramid::interpolate(const TextureView& view, double level, const V2d& place) const {
    const double clamped = std::clamp(level, 0.0, level_count() - 1.0);
    const int fine = static_cast<int>(clamped);
    const auto share = static_cast<float>(clamped - fine);
    const C4f value = interpolate(view, fine, place);
    if (share <= 0) return value;
    return value * (1 - share) + interpolate(view, fine + 1, place) * share;
}

C4f TexturePyramid::finish(const C4f& value) const {
    if (meaning_ != TexelMeaning::cutout || value.a <= 0) return value;
    return {value.r / value.a, value.g / value.a, value.b / value.a, value.a};
}

C4f TexturePyramid::at(const TextureView& view, const V2d& texcoord) const {
    return finish(interpolate(view, 0, transformed(view, texcoord)));
}

C4f TexturePyramid::average(const TextureView& view, const TextureFootprint& footprint) const {
    const V2d center = transformed(view, footprint.center);
    const V2d size(image_->width, image_->height);
    const V2d axis_u = transformed(view, footprint.center + footprint.axis_u) - center;
    const V2d axis_v = transformed(view, footprint.center + footprint.axis_v) - center;
    const Ellipse ellipse = ellipse_of(axis_u * size, axis_v * size);
    if (!(ellipse.long_length > 1)) return finish(interpolate(view, 0, center));

    // Square looks along the long axis, each as wide as the short one where their number allows that.
    const double short_length = std::max(ellipse.short_length, 1.0);
    const int looks = std::clamp(static_cast<int>(std::ceil(ellipse.long_length / short_length)), 1, max_looks);
    const double level = std::log2(std::max(ellipse.long_length / looks, 1.0));
    const V2d step = ellipse.long_axis / size;
    C4f sum(0, 0, 0, 0);
    for (int i = 0; i < looks; ++i) sum += interpolate(view, level, center + step * ((i + 0.5) / looks - 0.5));
    return finish(sum * (1.0F / static_cast<float>(looks)));
}

}  // namespace vmap
