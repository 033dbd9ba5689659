// SPDX-License-Identifier: GPL-3.0-or-later
#include <vmap/compare/comparison.h>
#include <vmap/compare/html_report.h>
#include <vmap/compare/picture_file.h>
#include <vmap/error.h>
#include <vmap/exporters/exr.h>
#include <vmap/exporters/ply.h>
#include <vmap/exporters/png.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace vmap {
namespace {

using Imath::C3f;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class CompareFiles : public testing::Test {
protected:
    void SetUp() override { std::filesystem::create_directories(folder); }
    void TearDown() override { std::filesystem::remove_all(folder); }

    [[nodiscard]] std::filesystem::path path(const std::string& name) const { return folder / name; }

    static Picture plain(int width, int height, const C3f& color) {
        return {.width = width,
                .height = height,
                .pixels = std::vector<C3f>(static_cast<std::size_t>(width * height), color)};
    }

    std::filesystem::path exr(const std::string& name, const Picture& picture) const {
        FileWriter file(path(name).string(), Durability::fast);
        write_exr(file, picture, {});
        file.commit();
        return path(name);
    }
    std::filesystem::path png(const std::string& name, const Picture& picture) const {
        FileWriter file(path(name).string(), Durability::fast);
        write_png(file, picture, {});
        file.commit();
        return path(name);
    }
    std::filesystem::path ply(const std::string& name, const LitCloud& cloud) const {
        FileWriter file(path(name).string(), Durability::fast);
        write_ply(file, cloud, {});
        file.commit();
        return path(name);
    }
    std::filesystem::path text(const std::string& name, const std::string& content) const {
        std::ofstream(path(name), std::ios::binary) << content;
        return path(name);
    }
    [[nodiscard]] std::string report(const Comparison& comparison) const {
        FileWriter file(path("report.html").string(), Durability::fast);
        write_html_report(file, comparison);
        file.commit();
        std::ifstream stream(path("report.html"));
        return {std::istreambuf_iterator<char>(stream), {}};
    }

    std::filesystem::path folder =
        std::filesystem::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
};

/// count x count points on the square from 0 to 1, on both sides of it: E is 1 + x in front and 5 behind, times a
/// factor; moved by a shift.
LitCloud two_sided_sheet(int count, float factor, float shift) {
    LitCloud cloud;
    const auto steps = static_cast<float>(count);
    for (int x = 0; x < count; ++x)
        for (int y = 0; y < count; ++y)
            for (const float side : {1.0F, -1.0F}) {
                const float u = (static_cast<float>(x) + 0.5F) / steps;
                cloud.points.positions.emplace_back(u + shift, (static_cast<float>(y) + 0.5F) / steps, 0.0F);
                cloud.points.normals.emplace_back(0.0F, 0.0F, side);
                cloud.points.areas.push_back(1 / (steps * steps));
                cloud.points.albedo.emplace_back(0.5F, 0.5F, 0.5F);
                cloud.points.faces.push_back(0);
                cloud.points.materials.push_back(0);
                const float value = factor * (side > 0 ? 1 + u : 5);
                cloud.irradiance.emplace_back(value, value, value);
            }
    return cloud;
}

TEST_F(CompareFiles, PicturesByPixel) {
    Picture other = plain(20, 10, {1, 2, 3});
    for (std::size_t i = 0; i < 20; ++i) other.pixels[i] = {1, 2, 3.6F};  // one row of ten
    const Comparison comparison = compare_files(exr("a.exr", other), exr("b.exr", plain(20, 10, {1, 2, 3})));
    EXPECT_EQ(comparison.figures().count, 200U);
    EXPECT_NEAR(comparison.figures().mean_reference, 2, 1e-6);
    EXPECT_NEAR(comparison.figures().mean, 0.01, 1e-6);
    EXPECT_NEAR(comparison.figures().median, 0, 1e-6);
    EXPECT_NEAR(comparison.figures().p95, 0.1, 1e-6);
    EXPECT_NEAR(comparison.figures().bias, 0.01, 1e-6);
    EXPECT_GT(comparison.pictures->comparison.flip, 0);
    EXPECT_TRUE(comparison.pictures->radiance);
}

TEST_F(CompareFiles, PngIsReadInLinearLight) {
    const Picture grey = plain(4, 3, {0.214F, 0.0F, 1.0F});  // sRGB 127 or 128 of 255
    const Picture read = read_picture(png("a.png", grey));
    EXPECT_NEAR(read.at(3, 2).x, 0.214, 0.002);
    EXPECT_EQ(read.at(0, 0).y, 0);
    EXPECT_NEAR(read.at(0, 0).z, 1, 1e-6);
    const Comparison comparison = compare_files(path("a.png"), exr("b.exr", grey));
    EXPECT_LT(comparison.figures().largest, 0.01);
    EXPECT_FALSE(comparison.pictures->radiance);
}

TEST_F(CompareFiles, CloudsByNearestPointOfTheSameSide) {
    const auto reference = ply("b.ply", two_sided_sheet(40, 1, 0));
    const Comparison same = compare_files(ply("a.ply", two_sided_sheet(40, 1, 0.001F)), reference);
    EXPECT_NEAR(same.figures().largest, 0, 1e-6);
    EXPECT_NEAR(same.clouds->mean_distance, 0.001, 1e-5);
    EXPECT_EQ(same.figures().count, 3200U);

    const Comparison brighter = compare_files(ply("a.ply", two_sided_sheet(40, 1.1F, 0.001F)), reference);
    EXPECT_NEAR(brighter.figures().mean, 0.1, 1e-5);
    EXPECT_NEAR(brighter.figures().bias, 0.1, 1e-5);

    // Another sampling of the same light: off by the slope over half a spacing at most.
    const Comparison coarser = compare_files(ply("a.ply", two_sided_sheet(37, 1, 0)), reference);
    EXPECT_LT(coarser.figures().largest, 0.5 / 37 / 3.25 + 1e-3);
}

TEST_F(CompareFiles, CloudsFarFromTheOriginKeepTheirDigits) {
    LitCloud a = two_sided_sheet(20, 1, 0);
    LitCloud b = a;
    a.points.origin = b.points.origin = {4.5e6, -3e6, 100};
    const Comparison comparison = compare_files(ply("a.ply", a), ply("b.ply", b));
    EXPECT_NEAR(comparison.clouds->mean_distance, 0, 1e-5);
    EXPECT_EQ(comparison.figures().largest, 0);
}

TEST_F(CompareFiles, FilesThatCannotBeComparedAreRefused) {
    const auto picture = exr("a.exr", plain(4, 3, {1, 1, 1}));
    EXPECT_THROW((void)compare_files(picture, exr("b.exr", plain(3, 4, {1, 1, 1}))), UsageError);
    EXPECT_THROW((void)compare_files(picture, ply("b.ply", two_sided_sheet(2, 1, 0))), UsageError);
    EXPECT_THROW((void)compare_files(picture, text("empty.exr", "")), FileError);
    EXPECT_THROW((void)compare_files(picture, path("absent.exr")), FileError);
    EXPECT_THROW((void)compare_files(picture, folder), FileError);
    LitCloud unlit = two_sided_sheet(2, 1, 0);
    unlit.irradiance.clear();
    EXPECT_THROW((void)compare_files(path("b.ply"), ply("unlit.ply", unlit)), UsageError);
    Picture broken = plain(4, 3, {1, 1, 1});
    broken.pixels[5].y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW((void)compare_files(picture, exr("nan.exr", broken)), FileError);
}

TEST_F(CompareFiles, CutOffPicturesAreFileErrors) {
    Picture noise = plain(32, 32, {0, 0, 0});
    for (std::size_t i = 0; i < noise.pixels.size(); ++i) noise.pixels[i].x = static_cast<float>(i * 7919 % 1000);
    for (const auto& file : {exr("a.exr", noise), png("a.png", noise)}) {
        const auto size = std::filesystem::file_size(file);
        for (const double share : {0.9, 0.5, 0.1}) {
            std::filesystem::resize_file(file, static_cast<std::uintmax_t>(share * static_cast<double>(size)));
            EXPECT_THROW((void)read_picture(file), FileError) << file << " at " << share;
        }
    }
}

TEST_F(CompareFiles, LimitsThatAreExceededAreNamed) {
    const Comparison comparison =
        compare_files(exr("a.exr", plain(20, 10, {1.1F, 1.1F, 1.1F})), exr("b.exr", plain(20, 10, {1, 1, 1})));
    EXPECT_TRUE(exceeded_limits(comparison, {}).empty());
    ComparisonLimits limits;
    limits.median = 0.2;
    EXPECT_TRUE(exceeded_limits(comparison, limits).empty());
    limits.p95 = 0.05;
    limits.bias = 0.01;
    EXPECT_THAT(exceeded_limits(comparison, limits), ElementsAre("p95 0.1 is above 0.05", "bias 0.1 is above 0.01"));
    limits = {};
    limits.flip = 0.5;
    EXPECT_TRUE(exceeded_limits(comparison, limits).empty());
    const auto cloud = ply("a.ply", two_sided_sheet(2, 1, 0));
    EXPECT_THROW((void)exceeded_limits(compare_files(cloud, cloud), limits), UsageError);
}

TEST_F(CompareFiles, ReportHoldsEverythingInOneFile) {
    const Comparison comparison =
        compare_files(exr("a<b>&\".exr", plain(20, 10, {1.5F, 1, 1})), exr("b.exr", plain(20, 10, {1, 1, 1})));
    const std::string html = report(comparison);
    EXPECT_THAT(html, HasSubstr("a&lt;b&gt;&amp;&quot;.exr"));
    EXPECT_THAT(html, Not(HasSubstr("a<b>")));
    EXPECT_THAT(html, HasSubstr("type=\"range\""));
    EXPECT_THAT(html, HasSubstr("flicker"));
    EXPECT_THAT(html, HasSubstr("<svg"));
    EXPECT_THAT(html, HasSubstr("16.667 %"));
    for (const char* outside : {"http:", "https:", "src=\"/", "url("}) EXPECT_THAT(html, Not(HasSubstr(outside)));

    const auto cloud = ply("a.ply", two_sided_sheet(3, 1, 0));
    EXPECT_THAT(report(compare_files(cloud, cloud)), HasSubstr("distance to the nearest point"));
}

TEST_F(CompareFiles, FiguresHaveFixedNamesInJson) {
    const auto picture = exr("a.exr", plain(4, 3, {1, 1, 1}));
    const nlohmann::json json = json_of(compare_files(picture, picture));
    for (const char* key : {"result", "reference", "count", "mean_reference", "mean", "median", "p95", "p99", "largest",
                            "rmse", "bias", "flip", "width", "height"})
        EXPECT_TRUE(json.contains(key)) << key;
}

}  // namespace
}  // namespace vmap
