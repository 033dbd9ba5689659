// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A fresh folder for the files of one test, and small clouds to write into it.
#pragma once

#include <vmap/point_cloud.h>

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace vmap {

/// Goes away with the test.
class OutputFolder : public testing::Test {
protected:
    OutputFolder()
        : folder(std::filesystem::path(testing::TempDir()) / ("vmap_exporters_" + std::to_string(::getpid()))) {
        std::filesystem::create_directories(folder);
    }
    ~OutputFolder() override { std::filesystem::remove_all(folder); }

    [[nodiscard]] std::string path(const std::string& name) const { return (folder / name).string(); }
    [[nodiscard]] std::string content(const std::string& name) const {
        std::ifstream file(path(name), std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    [[nodiscard]] std::size_t file_count() const {
        using Iterator = std::filesystem::directory_iterator;
        return static_cast<std::size_t>(std::distance(Iterator(folder), Iterator()));
    }

    std::filesystem::path folder;
};

inline LitCloud two_points() {
    LitCloud cloud;
    cloud.points.positions = {{1, 2, 3}, {4, 5, 6}};
    cloud.points.normals = {{0, 1, 0}, {1, 0, 0}};
    cloud.points.areas = {0.5F, 0.25F};
    cloud.points.albedo = {{0.1F, 0.2F, 0.3F}, {0.4F, 0.5F, 0.6F}};
    cloud.irradiance = {{1e4F, 2, 3}, {4, 5, 6}};
    return cloud;
}

/// A floor of side x side points, one world unit apart, in the plane y = 0 and facing up. E = (10 + x, 1, 1).
inline LitCloud floor_points(int side) {
    LitCloud cloud;
    for (int z = 0; z < side; ++z) {
        for (int x = 0; x < side; ++x) {
            cloud.points.positions.emplace_back(static_cast<float>(x), 0.0F, static_cast<float>(z));
            cloud.points.normals.emplace_back(0.0F, 1.0F, 0.0F);
            cloud.points.areas.push_back(1);
            cloud.points.albedo.emplace_back(0.5F, 0.5F, 0.5F);
            cloud.irradiance.emplace_back(10 + static_cast<float>(x), 1.0F, 1.0F);
        }
    }
    return cloud;
}

}  // namespace vmap
