// SPDX-License-Identifier: GPL-3.0-or-later
#include "../exporters/output_folder.h"

#include <vmap/exporters/gltf_points.h>
#include <vmap/exporters/ply.h>
#include <vmap/importers/input.h>

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

namespace vmap {
namespace {

using Imath::V3d;

struct Format {
    std::string file;
    bool has_ids;  ///< faces and materials
    std::function<void(FileWriter&, const LitCloud&, const OutputInfo&)> write;
};

std::vector<Format> formats() {
    return {
        {"lit.ply", true, [](auto& file, auto& cloud, auto& info) { write_ply(file, cloud, info); }},
        {"lit.glb", false, [](auto& file, auto& cloud, auto& info) { write_gltf_points(file, cloud, info); }},
        {"lit.gltf", false,
         [](auto& file, auto& cloud, auto& info) {
             write_gltf_points(file, cloud, info, {.container = GltfContainer::embedded});
         }},
    };
}

LitCloud full_cloud() {
    LitCloud cloud = floor_points(30);
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
        const auto x = static_cast<float>(i);
        cloud.points.emission.emplace_back(x, 0.0F, 1e5F);
        cloud.points.areas[i] = 0.5F + 0.001F * x;
        cloud.points.faces.push_back(static_cast<std::uint32_t>(i / 2));
        cloud.points.materials.push_back(static_cast<std::uint32_t>(i % 3));
        cloud.irradiance[i] = {1e-6F * x, 1.0F / 3, 1e6F};
    }
    return cloud;
}

class RoundTrip : public OutputFolder {
protected:
    [[nodiscard]] PointFile there_and_back(const Format& format, const LitCloud& cloud, const OutputInfo& info) const {
        FileWriter file(path(format.file));
        format.write(file, cloud, info);
        file.commit();
        const Input input = read_input(path(format.file));
        EXPECT_TRUE(input.points.has_value());
        return input.points.value_or(PointFile());
    }
};

/// Positions in the world, whatever the origin.
std::vector<V3d> world_positions(const PointCloud& cloud) {
    std::vector<V3d> positions;
    positions.reserve(cloud.size());
    for (const Imath::V3f& position : cloud.positions) positions.push_back(cloud.origin + V3d(position));
    return positions;
}

TEST_F(RoundTrip, KeepsEverythingExactlyWithEitherAxisUp) {
    const LitCloud cloud = full_cloud();
    for (const Format& format : formats()) {
        for (const UpAxis up : {UpAxis::y, UpAxis::z}) {
            SCOPED_TRACE(format.file + ", up " + std::string(name_of(up)));
            OutputInfo info;
            info.up = up;
            info.light_units = LightUnits::raw;
            info.exposure = 0.75;
            info.source = "room \"1\".glb";
            const PointFile back = there_and_back(format, cloud, info);
            EXPECT_TRUE(back.ours);
            EXPECT_EQ(back.light_units, LightUnits::raw);
            EXPECT_EQ(back.exposure, 0.75);
            EXPECT_EQ(back.source, "room \"1\".glb");
            EXPECT_EQ(world_positions(back.cloud.points), world_positions(cloud.points));
            EXPECT_EQ(back.cloud.points.normals, cloud.points.normals);
            EXPECT_EQ(back.cloud.points.areas, cloud.points.areas);
            EXPECT_EQ(back.cloud.points.albedo, cloud.points.albedo);
            EXPECT_EQ(back.cloud.points.emission, cloud.points.emission);
            EXPECT_EQ(back.cloud.irradiance, cloud.irradiance);
            if (!format.has_ids) continue;
            EXPECT_EQ(back.cloud.points.faces, cloud.points.faces);
            EXPECT_EQ(back.cloud.points.materials, cloud.points.materials);
        }
    }
}

TEST_F(RoundTrip, FarCloudIsRestoredToATenthOfAMillimetre) {
    LitCloud cloud = full_cloud();
    for (auto& position : cloud.points.positions) position *= 0.001F;
    for (auto& area : cloud.points.areas) area = 1e-6F;
    cloud.points.origin = {4.5e6, -4.5e6, 123.456};
    for (const Format& format : formats()) {
        for (const UpAxis up : {UpAxis::y, UpAxis::z}) {
            SCOPED_TRACE(format.file + ", up " + std::string(name_of(up)));
            OutputInfo info;
            info.up = up;
            const auto back = world_positions(there_and_back(format, cloud, info).cloud.points);
            const auto wanted = world_positions(cloud.points);
            ASSERT_EQ(back.size(), wanted.size());
            for (std::size_t i = 0; i < wanted.size(); ++i) ASSERT_LT((back[i] - wanted[i]).length(), 1e-4);
        }
    }
}

}  // namespace
}  // namespace vmap
