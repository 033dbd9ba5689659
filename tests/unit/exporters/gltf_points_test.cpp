// SPDX-License-Identifier: GPL-3.0-or-later
#include "output_folder.h"

#include <vmap/error.h>
#include <vmap/exporters/gltf_points.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cstring>
#include <string>
#include <vector>

namespace vmap {
namespace {

using nlohmann::json;
using testing::ElementsAre;

std::uint32_t word_at(const std::string& bytes, std::size_t position) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + position, sizeof word);
    return word;
}

/// A .glb file taken apart by the rules of its container.
struct Glb {
    json document;
    std::string data;

    explicit Glb(const std::string& bytes) {
        EXPECT_EQ(bytes.substr(0, 4), "glTF");
        EXPECT_EQ(word_at(bytes, 8), bytes.size());
        const std::size_t json_size = word_at(bytes, 12);
        EXPECT_EQ(bytes.substr(16, 4), "JSON");
        EXPECT_EQ(json_size % 4, 0U);
        document = json::parse(bytes.substr(20, json_size));
        if (bytes.size() > 20 + json_size) data = bytes.substr(28 + json_size);
    }

    [[nodiscard]] std::vector<float> values(const std::string& attribute) const {
        const std::size_t accessor = document["meshes"][0]["primitives"][0]["attributes"][attribute];
        EXPECT_EQ(document["accessors"][accessor]["type"], "VEC3");
        const json& view = document["bufferViews"][document["accessors"][accessor]["bufferView"].get<std::size_t>()];
        std::vector<float> result(view["byteLength"].get<std::size_t>() / sizeof(float));
        std::memcpy(result.data(), data.data() + view["byteOffset"].get<std::size_t>(), view["byteLength"]);
        return result;
    }
};

/// Base64, digit by digit.
std::string decoded(const std::string& text) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        if (c == '=') break;
        bits = bits << 6 | static_cast<std::uint32_t>(digits.find(c));
        count += 6;
        if (count < 8) continue;
        count -= 8;
        bytes.push_back(static_cast<char>(bits >> count & 0xFF));
    }
    return bytes;
}

class GltfPoints : public OutputFolder {
protected:
    std::string write(const LitCloud& cloud, const OutputInfo& info = {}, const GltfPointsConfig& config = {}) {
        FileWriter file(path("lit.glb"));
        write_gltf_points(file, cloud, info, config);
        file.commit();
        return content("lit.glb");
    }
};

TEST_F(GltfPoints, HoldsTheAttributesOfTheContract) {
    const Glb glb(write(two_points()));
    EXPECT_EQ(glb.document["meshes"][0]["primitives"][0]["mode"], 0);
    EXPECT_THAT(glb.values("POSITION"), ElementsAre(1, 2, 3, 4, 5, 6));
    EXPECT_THAT(glb.values("_IRRADIANCE"), ElementsAre(1e4F, 2, 3, 4, 5, 6));
    EXPECT_THAT(glb.values("_ALBEDO"), ElementsAre(0.1F, 0.2F, 0.3F, 0.4F, 0.5F, 0.6F));
    EXPECT_THAT(glb.values("_NORMAL"), ElementsAre(0, 1, 0, 1, 0, 0));
    EXPECT_FALSE(glb.document["meshes"][0]["primitives"][0]["attributes"].contains("NORMAL"));
    EXPECT_THAT(glb.document["accessors"][0]["min"], ElementsAre(1, 2, 3));
    EXPECT_THAT(glb.document["accessors"][0]["max"], ElementsAre(4, 5, 6));
}

TEST_F(GltfPoints, ColorsAreExposedRadianceWithinTheUnitRange) {
    const Glb glb(write(two_points(), {.exposure = 0.5, .source = ""}));
    const float pi = std::numbers::pi_v<float>;
    const std::vector<float> colors = glb.values("COLOR_0");
    EXPECT_EQ(colors[0], 1);
    EXPECT_NEAR(colors[1], 0.5F * 0.2F * 2 / pi, 1e-6);
    EXPECT_NEAR(colors[5], 0.5F * 0.6F * 6 / pi, 1e-6);
}

TEST_F(GltfPoints, NormalsAreWrittenOnRequest) {
    const Glb glb(write(two_points(), {}, {.normals = true}));
    EXPECT_THAT(glb.values("NORMAL"), ElementsAre(0, 1, 0, 1, 0, 0));
}

TEST_F(GltfPoints, MeanRadiusIsThatOfTheDiscs) {
    const Glb glb(write(two_points()));
    const double pi = std::numbers::pi;
    EXPECT_NEAR(glb.document["meshes"][0]["extras"]["radius"], (std::sqrt(0.5 / pi) + std::sqrt(0.25 / pi)) / 2, 1e-6);
}

TEST_F(GltfPoints, EmissionAndAreasAreKeptExactly) {
    LitCloud cloud = two_points();
    cloud.points.emission = {{0, 0, 0}, {1e5F, 2, 3}};
    const Glb glb(write(cloud));
    EXPECT_THAT(glb.values("_EMISSION"), ElementsAre(0, 0, 0, 1e5F, 2, 3));
    const json& areas = glb.document["accessors"][glb.document["meshes"][0]["extras"]["areas"].get<std::size_t>()];
    EXPECT_EQ(areas["type"], "SCALAR");
    const json& view = glb.document["bufferViews"][areas["bufferView"].get<std::size_t>()];
    std::array<float, 2> values{};
    std::memcpy(values.data(), glb.data.data() + view["byteOffset"].get<std::size_t>(), sizeof values);
    EXPECT_THAT(values, ElementsAre(0.5F, 0.25F));
}

TEST_F(GltfPoints, FarCloudKeepsItsDigitsInTheNode) {
    LitCloud cloud = two_points();
    cloud.points.origin = {4.5e6, 0, 0.001};
    const Glb glb(write(cloud, {.up = UpAxis::z, .source = ""}));
    EXPECT_THAT(glb.document["nodes"][0]["translation"], ElementsAre(4.5e6, -0.001, 0));
    EXPECT_THAT(glb.values("POSITION"), ElementsAre(1, -3, 2, 4, -6, 5));
}

TEST_F(GltfPoints, EmbeddedFileHoldsTheSameDataInBase64) {
    LitCloud cloud = floor_points(150);
    const OutputInfo info{.source = ";base64,*"};
    const Glb glb(write(cloud, info));
    const json document = json::parse(write(cloud, info, {.container = GltfContainer::embedded}));
    const std::string uri = document["buffers"][0]["uri"];
    const std::string prefix = "data:application/octet-stream;base64,";
    ASSERT_EQ(uri.substr(0, prefix.size()), prefix);
    EXPECT_EQ(decoded(uri.substr(prefix.size())), glb.data);
    EXPECT_EQ(document["accessors"], glb.document["accessors"]);
}

TEST_F(GltfPoints, NoPointsIsAnEmptyScene) {
    const Glb glb(write({}));
    EXPECT_FALSE(glb.document.contains("meshes"));
    EXPECT_TRUE(glb.document["scenes"].is_array());
}

}  // namespace
}  // namespace vmap
