// SPDX-License-Identifier: GPL-3.0-or-later
// Small files of meshes and points, written by hand.
#include <vmap/error.h>
#include <vmap/importers/input.h>

#include "measure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

namespace vmap {
namespace {

using namespace test;
using Imath::V3d;
using Imath::V3f;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

class MeshFormats : public testing::Test {
protected:
    void SetUp() override {
        folder_ =
            std::filesystem::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    [[nodiscard]] Input read(const std::string& name, const std::string& content) const {
        std::ofstream(folder_ / name, std::ios::binary) << content;
        return read_input(folder_ / name);
    }

    void write(const std::string& name, const std::string& content) const {
        std::ofstream(folder_ / name, std::ios::binary) << content;
    }

private:
    std::filesystem::path folder_;
};

/// Sum over the triangles of normal times place: three times the volume where all fronts face outward.
double three_volumes(const Scene& scene) {
    double sum = 0;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
            const auto corner = [&](std::size_t k) { return V3d(mesh.positions[mesh.indices[i + k]]); };
            sum += corner(0).dot(corner(1).cross(corner(2))) / 2;
        }
    }
    return sum;
}

const std::string cube_vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n";

TEST_F(MeshFormats, PolygonsFaceTheSideThatMostOfTheirNeighboursFace) {
    const std::string outward = "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\n";
    const Input sound = read("sound.obj", cube_vertices + outward + "f 4 1 5 8\n");
    EXPECT_THAT(sound.scene.warnings, IsEmpty());
    EXPECT_NEAR(three_volumes(sound.scene), 3, 1e-6);
    const Input turned = read("turned.obj", cube_vertices + outward + "f 8 5 1 4\n");
    EXPECT_THAT(turned.scene.warnings, Contains(HasSubstr("2 triangles are wound against their neighbours")));
    EXPECT_NEAR(three_volumes(turned.scene), 3, 1e-6);
    EXPECT_NEAR(measure_of(turned.scene).area, 6, 1e-6);
}

TEST_F(MeshFormats, MoebiusStripIsReadWithAWarning) {
    std::string strip;
    for (int i = 0; i < 8; ++i)
        for (const double side : {-0.3, 0.3}) {
            const double angle = i * 3.14159265358979 / 4;
            const double r = 1 + side * std::cos(angle / 2);
            strip += "v " + std::to_string(r * std::cos(angle)) + " " + std::to_string(r * std::sin(angle)) + " " +
                     std::to_string(side * std::sin(angle / 2)) + "\n";
        }
    for (int i = 0; i < 7; ++i) {
        const int a = 2 * i + 1;
        strip += "f " + std::to_string(a) + " " + std::to_string(a + 1) + " " + std::to_string(a + 3) + " " +
                 std::to_string(a + 2) + "\n";
    }
    const Input input = read("moebius.obj", strip + "f 15 16 1 2\n");
    EXPECT_THAT(input.scene.warnings, Contains(HasSubstr("no consistent orientation")));
    EXPECT_EQ(measure_of(input.scene).triangles, 16U);
}

TEST_F(MeshFormats, DegenerateFacesAreDroppedAndCounted) {
    const Input input = read("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\nf 1 2 4\nf 1 1 2\nf 1 2\n");
    EXPECT_EQ(measure_of(input.scene).triangles, 1U);
    EXPECT_EQ(input.facts.polygons, 4U);
    EXPECT_THAT(input.scene.warnings, Contains(HasSubstr("2 faces without area: dropped")));
    EXPECT_THAT(input.scene.warnings, Contains(HasSubstr("1 faces with fewer than 3 vertices: dropped")));
}

TEST_F(MeshFormats, ConcavePolygonKeepsItsArea) {
    const Input input = read("arrow.obj", "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 0.5 0\nv 0 2 0\nf 1 2 3 4 5\n");
    EXPECT_NEAR(measure_of(input.scene).area, 4 - 1.5, 1e-6);
}

TEST_F(MeshFormats, MaterialsOfObjAreRead) {
    write("two.mtl", "newmtl lamp\nKd 0.25 0.5 1\nKe 3 2 1\nnewmtl grey\n");
    const Input input =
        read("two.obj", "mtllib two.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl lamp\nf 1 2 3\nusemtl grey\nf 1 3 2\n");
    const auto named = [&](const std::string& name) {
        for (const Material& material : input.scene.materials)
            if (material.name == name) return material;
        ADD_FAILURE() << "no material " << name;
        return Material();
    };
    EXPECT_EQ(named("lamp").base_color, Imath::C4f(0.25F, 0.5F, 1, 1));
    EXPECT_EQ(named("lamp").emission, Imath::C3f(3, 2, 1));
    EXPECT_EQ(named("grey").base_color, Imath::C4f(0.8F, 0.8F, 0.8F, 1));
    EXPECT_NEAR(measure_of(input.scene).emissive_area, 0.5, 1e-6);
}

TEST_F(MeshFormats, IndicesOfNormalsThatTheFileLacksAreLeftOut) {
    const Input input = read("no_normals.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1//1 2//2 3//3\n");
    EXPECT_EQ(measure_of(input.scene).triangles, 1U);
    EXPECT_THAT(input.scene.warnings, Contains(HasSubstr("faces use normals, but the file has none")));
    EXPECT_THROW(static_cast<void>(read("one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//2 3//3\n")),
                 FileError);
}

TEST_F(MeshFormats, PlyOfAnyScalarTypeIsRead) {
    const Input input = read("short.ply",
                             "ply\nformat ascii 1.0\nelement vertex 4\nproperty short x\nproperty double y\nproperty "
                             "uchar z\nelement face 1\nproperty list uint8 uint16 vertex_index\nend_header\n0 0 0\n2 0 "
                             "0\n2 2 0\n0 2 0\n4 0 1 2 3\n");
    EXPECT_NEAR(measure_of(input.scene).area, 4, 1e-6);
    EXPECT_EQ(input.facts.vertices, 4U);
    EXPECT_EQ(input.facts.polygons, 1U);
}

TEST_F(MeshFormats, OffWithColoursIsRead) {
    const Input input =
        read("c.off", "COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 255 0 0 255\n0 1 0 255 0 0 255\n3 0 1 2\n");
    ASSERT_EQ(input.scene.meshes.size(), 1U);
    EXPECT_THAT(input.scene.meshes[0].colors, testing::Each(Imath::C4f(1, 0, 0, 1)));
}

std::string binary_stl(const V3f& normal) {
    std::string bytes(80, ' ');
    const std::uint32_t count = 1;
    const float corners[12] = {normal.x, normal.y, normal.z, 0, 0, 0, 1, 0, 0, 0, 1, 0};
    bytes.append(reinterpret_cast<const char*>(&count), sizeof count);
    bytes.append(reinterpret_cast<const char*>(corners), sizeof corners);
    return bytes + std::string(2, '\0');
}

TEST_F(MeshFormats, StlWithNormalsThatAreNoneIsReadWithAWarning) {
    EXPECT_THAT(read("sound.stl", binary_stl({0, 0, 1})).scene.warnings, IsEmpty());
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::string text =
        "solid s\nfacet normal nan nan nan\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
        "0\nendloop\nendfacet\nendsolid s\n";
    for (const Input& input : {read("nan.stl", binary_stl({nan, nan, nan})), read("text.stl", text)}) {
        EXPECT_THAT(input.scene.warnings, Contains(HasSubstr("facet normals")));
        EXPECT_NEAR(measure_of(input.scene).area, 0.5, 1e-6);
    }
}

TEST_F(MeshFormats, NormalsOfForeignPointsAreMadeUnitOrLeftOut) {
    const std::string header =
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nproperty float "
        "nx\nproperty float ny\nproperty float nz\nend_header\n0 0 0 0 0 5\n";
    const Input long_ones = read("long.ply", header + "1 0 0 0 3 0\n");
    ASSERT_TRUE(long_ones.points);
    // The file is z up, the world y up.
    EXPECT_THAT(long_ones.points->cloud.points.normals, testing::ElementsAre(V3f(0, 1, 0), V3f(0, 0, -1)));
    const Input zero = read("zero.ply", header + "1 0 0 0 0 0\n");
    ASSERT_TRUE(zero.points);
    EXPECT_THAT(zero.points->cloud.points.normals, IsEmpty());
    EXPECT_THAT(zero.scene.warnings, Contains(HasSubstr("normals of points")));
}

TEST_F(MeshFormats, ColumnsOfXyzAreTold) {
    const Input input = read("scan.xyz", "# x y z normal colour\n2\n0 0 0 0 0 1 255 0 0\n1 0 0 0 1 0 0 255 0\n");
    ASSERT_TRUE(input.points);
    EXPECT_EQ(input.points->cloud.points.normals.size(), 2U);
    EXPECT_THAT(input.points->cloud.points.albedo, testing::ElementsAre(Imath::C3f(1, 0, 0), Imath::C3f(0, 1, 0)));
}

}  // namespace
}  // namespace vmap
