// SPDX-License-Identifier: GPL-3.0-or-later
#include "output_folder.h"

#include <vmap/error.h>
#include <vmap/exporters/vdb_grid.h>
#include <vmap/exporters/vdb_points.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <openvdb/openvdb.h>
#include <openvdb/points/PointConversion.h>
#include <openvdb/points/PointCount.h>
#include <tbb/global_control.h>

#include <limits>
#include <map>
#include <string>

namespace vmap {
namespace {

using openvdb::Coord;
using openvdb::Vec3f;

class VdbFile : public OutputFolder {
protected:
    VdbFile() { openvdb::initialize(); }

    void write_grid(const LitCloud& cloud, const OutputInfo& info = {}, const VdbGridConfig& config = {}) const {
        FileWriter file(path("lit.vdb"));
        write_vdb_grid(file, cloud, info, config);
        file.commit();
    }
    void write_points(const LitCloud& cloud, const OutputInfo& info = {}) const {
        FileWriter file(path("lit.vdb"));
        write_vdb_points(file, cloud, info);
        file.commit();
    }

    template <class Grid>
    [[nodiscard]] typename Grid::Ptr read(const std::string& name) const {
        openvdb::io::File file(path("lit.vdb"));
        file.open();
        return openvdb::gridPtrCast<Grid>(file.readGrid(name));
    }
};

TEST_F(VdbFile, DensityIsOneWherePointsAreAndNowhereElse) {
    write_grid(two_points(), {}, {.voxel_size = 0.5});
    const auto density = read<openvdb::FloatGrid>("density");
    EXPECT_EQ(density->activeVoxelCount(), 2U);
    EXPECT_EQ(density->tree().getValue(Coord(2, 4, 6)), 1);
    EXPECT_EQ(density->tree().getValue(Coord(8, 10, 12)), 1);
    EXPECT_EQ(density->background(), 0);
    EXPECT_EQ(density->getGridClass(), openvdb::GRID_FOG_VOLUME);
}

TEST_F(VdbFile, IrradianceIsTheAreaMeanOfAVoxel) {
    LitCloud cloud = two_points();
    cloud.points.positions[1] = cloud.points.positions[0];
    write_grid(cloud, {}, {.voxel_size = 1});
    const auto irradiance = read<openvdb::Vec3SGrid>("irradiance");
    const Vec3f mean = irradiance->tree().getValue(Coord(1, 2, 3));
    EXPECT_FLOAT_EQ(mean.x(), (2 * 1e4F + 4) / 3);
    EXPECT_FLOAT_EQ(mean.y(), (2 * 2.0F + 5) / 3);
    EXPECT_EQ(irradiance->getVectorType(), openvdb::VEC_INVARIANT);
}

TEST_F(VdbFile, IrradianceGoesOnForTwoVoxelsAroundASurface) {
    LitCloud cloud = floor_points(9);
    for (auto& e : cloud.irradiance) e = {3, 2, 1};
    write_grid(cloud, {}, {.voxel_size = 1});
    const auto irradiance = read<openvdb::Vec3SGrid>("irradiance");
    for (int y = -2; y <= 2; ++y) EXPECT_EQ(irradiance->tree().getValue(Coord(4, y, 4)), Vec3f(3, 2, 1)) << y;
    EXPECT_EQ(irradiance->tree().getValue(Coord(10, 2, 10)), Vec3f(3, 2, 1));
    EXPECT_FALSE(irradiance->tree().isValueOn(Coord(4, 3, 4)));
    EXPECT_FALSE(irradiance->tree().isValueOn(Coord(11, 0, 4)));
    EXPECT_EQ(irradiance->activeVoxelCount(), 13U * 13U * 5U);
}

TEST_F(VdbFile, DefaultVoxelsLeaveNoHolesInASurface) {
    LitCloud cloud = floor_points(64);
    write_grid(cloud);
    const auto density = read<openvdb::FloatGrid>("density");
    EXPECT_EQ(density->voxelSize().x(), 2);
    const openvdb::CoordBBox box = density->evalActiveVoxelBoundingBox();
    EXPECT_EQ(density->activeVoxelCount(), static_cast<std::size_t>(box.dim().x() * box.dim().z()));
}

TEST_F(VdbFile, MetadataSaysWhatTheGridIs) {
    write_grid(two_points(), {.up = UpAxis::z, .light_units = LightUnits::raw, .source = "room\n.glb"});
    const auto irradiance = read<openvdb::Vec3SGrid>("irradiance");
    EXPECT_EQ(irradiance->metaValue<std::string>("up"), "z");
    EXPECT_EQ(irradiance->metaValue<std::string>("light_units"), "raw");
    EXPECT_NEAR(irradiance->metaValue<double>("light_factor_punctual"), 1 / (4 * std::numbers::pi), 1e-15);
    EXPECT_EQ(irradiance->metaValue<std::string>("source"), "room\\n.glb");
    EXPECT_THAT(irradiance->getCreator(), testing::StartsWith("vmap "));
    EXPECT_GT(irradiance->metaValue<openvdb::Int64>("file_voxel_count"), 0);
}

TEST_F(VdbFile, AxesAndOffsetPlaceTheVoxelsInTheWorld) {
    LitCloud cloud = two_points();
    cloud.points.areas = {1e-6F, 1e-6F};
    cloud.points.origin = {4.5e6, 0, 0};
    write_grid(cloud, {.up = UpAxis::z, .source = ""}, {.voxel_size = 0.125});
    const auto density = read<openvdb::FloatGrid>("density");
    EXPECT_EQ(density->tree().getValue(Coord(8, -24, 16)), 1);
    EXPECT_EQ(density->indexToWorld(Coord(8, -24, 16)), openvdb::Vec3d(4.5e6 + 1, -3, 2));
}

TEST_F(VdbFile, EmptyCloudStillHasALeaf) {
    write_grid(LitCloud{});
    EXPECT_EQ(read<openvdb::FloatGrid>("density")->tree().leafCount(), 1U);
}

TEST_F(VdbFile, VoxelSizesThatMakeNoSenseAreUsageErrors) {
    for (const double size : {-1.0, std::numeric_limits<double>::quiet_NaN(), 1e-9, 1e-320})
        EXPECT_THROW(write_grid(floor_points(8), {}, {.voxel_size = size}), UsageError) << size;
    EXPECT_EQ(file_count(), 0U);
}

/// Values of an attribute by position, both rounded to nothing.
std::map<std::array<double, 3>, Vec3f> by_position(const openvdb::points::PointDataGrid& grid, const char* name) {
    std::map<std::array<double, 3>, Vec3f> values;
    for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
        const openvdb::points::AttributeHandle<Vec3f> positions(leaf->constAttributeArray("P"));
        const openvdb::points::AttributeHandle<Vec3f> attribute(leaf->constAttributeArray(name));
        for (auto index = leaf->beginIndexOn(); index; ++index) {
            const openvdb::Vec3d place =
                grid.indexToWorld(openvdb::Vec3d(positions.get(*index)) + index.getCoord().asVec3d());
            values[{place.x(), place.y(), place.z()}] = attribute.get(*index);
        }
    }
    return values;
}

TEST_F(VdbFile, PointsReadBackExactly) {
    write_points(two_points());
    const auto grid = read<openvdb::points::PointDataGrid>("points");
    ASSERT_EQ(openvdb::points::pointCount(grid->tree()), 2U);
    const auto irradiance = by_position(*grid, "irradiance");
    const auto normals = by_position(*grid, "N");
    const auto colors = by_position(*grid, "Cd");
    ASSERT_EQ(irradiance.size(), 2U);
    EXPECT_EQ(irradiance.begin()->second, Vec3f(1e4F, 2, 3));
    EXPECT_EQ(irradiance.rbegin()->second, Vec3f(4, 5, 6));
    EXPECT_EQ(normals.begin()->second, Vec3f(0, 1, 0));
    EXPECT_FLOAT_EQ(colors.begin()->second.x(), 0.1F * 1e4F / std::numbers::pi_v<float>);
    EXPECT_NEAR(irradiance.begin()->first[0], 1, 1e-6);
    EXPECT_NEAR(irradiance.rbegin()->first[2], 6, 1e-6);
}

TEST_F(VdbFile, FarPointsKeepTheirDigits) {
    LitCloud cloud = two_points();
    cloud.points.areas = {1e-6F, 1e-6F};
    cloud.points.origin = {4.5e6, 4.5e6, 4.5e6};
    write_points(cloud);
    const auto values = by_position(*read<openvdb::points::PointDataGrid>("points"), "irradiance");
    EXPECT_NEAR(values.begin()->first[0], 4.5e6 + 1, 1e-5);
    EXPECT_NEAR(values.rbegin()->first[2], 4.5e6 + 6, 1e-5);
}

TEST_F(VdbFile, NoPointsIsAValidFile) {
    write_points({});
    EXPECT_EQ(openvdb::points::pointCount(read<openvdb::points::PointDataGrid>("points")->tree()), 0U);
}

TEST_F(VdbFile, BytesDependOnTheContentOnly) {
    const LitCloud cloud = floor_points(200);
    for (const bool points : {false, true}) {
        std::string expected;
        for (const std::size_t threads : {1, 2, 8}) {
            const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
            points ? write_points(cloud) : write_grid(cloud);
            if (expected.empty()) expected = content("lit.vdb");
            EXPECT_TRUE(content("lit.vdb") == expected) << threads;
        }
        LitCloud other = cloud;
        other.irradiance[7].x += 1;
        points ? write_points(other) : write_grid(other);
        EXPECT_NE(content("lit.vdb").substr(21, 36), expected.substr(21, 36));
    }
}

}  // namespace
}  // namespace vmap
