// SPDX-License-Identifier: GPL-3.0-or-later
#include <reference/lit_ply.h>
#include <vmap/error.h>
#include <vmap/exporters/ply.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace vmap::reference {
namespace {

using Imath::C3f;
using Imath::V3d;
using Imath::V3f;

class LitPlyFile : public testing::Test {
protected:
    void SetUp() override {
        file = std::filesystem::path(testing::TempDir()) /
               (std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".ply");
    }
    void TearDown() override { std::filesystem::remove(file); }

    static LitCloud two_points() {
        LitCloud cloud;
        cloud.points.positions = {{1, 2, 3}, {4, 5, 6}};
        cloud.points.normals = {{0, 1, 0}, {0, 0, -1}};
        cloud.points.areas = {0.25F, 0.5F};
        cloud.points.albedo = {{0.1F, 0.2F, 0.3F}, {0.4F, 0.5F, 0.6F}};
        cloud.points.faces = {7, 8};
        cloud.points.materials = {1, 2};
        cloud.irradiance = {{10, 20, 30}, {1e-6F, 1e6F, 0}};
        return cloud;
    }

    void write(const LitCloud& cloud, UpAxis up) const {
        OutputInfo info;
        info.up = up;
        info.source = "two points";
        FileWriter writer(file.string(), Durability::fast);
        write_ply(writer, cloud, info);
        writer.commit();
    }

    void write_text(const std::string& text) const { std::ofstream(file, std::ios::binary) << text; }

    [[nodiscard]] std::string text() const {
        std::ifstream stream(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }

    std::filesystem::path file;
};

TEST_F(LitPlyFile, WhatIsWrittenComesBackInTheWorldWhicheverAxisIsUp) {
    for (const UpAxis up : {UpAxis::y, UpAxis::z}) {
        write(two_points(), up);
        const LitPly points = read_lit_ply(file);
        ASSERT_EQ(points.size(), 2U);
        EXPECT_EQ(points.positions[1], V3d(4, 5, 6));
        EXPECT_EQ(points.normals[0], V3d(0, 1, 0));
        EXPECT_EQ(points.normals[1], V3d(0, 0, -1));
        EXPECT_EQ(points.irradiance[1], C3f(1e-6F, 1e6F, 0));
        EXPECT_EQ(points.albedo[0], C3f(0.1F, 0.2F, 0.3F));
        EXPECT_EQ(points.areas[1], 0.5);
        EXPECT_EQ(points.faces[1], 8U);
        EXPECT_TRUE(points.emission.empty());
        EXPECT_EQ(points.comments.at("source"), "two points");
    }
}

TEST_F(LitPlyFile, SurveyCoordinatesKeepTheirMillimetres) {
    LitCloud cloud = two_points();
    cloud.points.origin = {4.5e6, 10, -5.2e5};
    cloud.points.positions = {{0.001F, 0, 0}, {0.002F, 0, 0}};
    cloud.points.areas = {1e-6F, 1e-6F};
    write(cloud, UpAxis::z);
    const LitPly points = read_lit_ply(file);
    EXPECT_NEAR(points.positions[0].x - 4.5e6, 0.001, 1e-6);
    EXPECT_NEAR(points.positions[1].z, -5.2e5, 1e-6);
}

TEST_F(LitPlyFile, OtherFilesAreRefused) {
    EXPECT_THROW((void)read_lit_ply(file), FileError) << "absent";
    write_text("solid cube");
    EXPECT_THROW((void)read_lit_ply(file), FileError);
    write_text("ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nend_header\n");
    EXPECT_THROW((void)read_lit_ply(file), FileError);
    write_text("ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\nend_header\n1234");
    EXPECT_THROW((void)read_lit_ply(file), FileError) << "no irradiance";
    write(two_points(), UpAxis::y);
    const std::string whole = text();
    write_text(whole.substr(0, whole.size() - 1));
    EXPECT_THROW((void)read_lit_ply(file), FileError) << "cut off";
}

}  // namespace
}  // namespace vmap::reference
