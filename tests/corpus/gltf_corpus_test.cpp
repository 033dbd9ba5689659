// SPDX-License-Identifier: GPL-3.0-or-later
// Foreign glTF files: sound ones against independent counts, broken ones that have to be refused, and hostile ones.
#include "../unit/importers/measure.h"
#include "corpus.h"

#include <vmap/error.h>
#include <vmap/importers/gltf.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace vmap::test {
namespace {

constexpr std::size_t megabyte = 1U << 20U;

TEST(GltfCorpus, IsThere) {
    if (!std::filesystem::exists(corpus_folder()))
        GTEST_SKIP() << "the corpus is not at " << corpus_folder() << ": nothing foreign is read";
    EXPECT_FALSE(read_list(corpus_folder() / "gltf-bad" / "MUST_REJECT.list").empty());
}

std::vector<Row> sound_files() {
    std::vector<Row> rows = read_table(corpus_folder() / "gltf-ok" / "EXPECT.tsv");
    for (Row row : read_table(corpus_folder() / "analytic-gi" / "EXPECT.tsv")) {
        row["path"] = "analytic-gi/" + row["path"];
        rows.push_back(row);
    }
    return rows;
}

class SoundGltf : public testing::TestWithParam<Row> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SoundGltf);

TEST_P(SoundGltf, HasTheExpectedGeometry) {
    const Row& row = GetParam();
    const Input input = import_gltf(corpus_folder() / row.at("path"));
    Measure measure = measure_of(input.scene);
    EXPECT_EQ(std::to_string(measure.triangles), row.at("tris"));
    EXPECT_EQ(std::to_string(input.points ? input.points->cloud.points.size() : 0), row.at("points"));
    EXPECT_EQ(std::to_string(input.scene.lights.size()), row.at("lights"));
    if (input.points)
        for (const Imath::V3f& position : input.points->cloud.points.positions)
            measure.box.extendBy(Imath::V3d(position) + input.points->cloud.points.origin);

    const bool inexact = row.at("extRequired").find("draco") != std::string::npos || row.at("skin_or_inst") == "2";
    const double tolerance = inexact ? 1e-4 : 1e-5;
    const double area = std::stod(row.at("area"));
    EXPECT_NEAR(measure.area, area, tolerance * area);
    EXPECT_NEAR(measure.emissive_area, std::stod(row.at("emissive_area")), tolerance * area);
    const std::vector<double> box = numbers_in(row.at("bbox"));
    ASSERT_EQ(box.size(), 6);
    const double size = measure.box.size().length();
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(measure.box.min[i], box[i], tolerance * size);
        EXPECT_NEAR(measure.box.max[i], box[i + 3], tolerance * size);
    }
}

std::string name_of_row(const testing::TestParamInfo<Row>& row) {
    return test_name_of(row.param.at("path"));
}
INSTANTIATE_TEST_SUITE_P(Corpus, SoundGltf, testing::ValuesIn(sound_files()), name_of_row);

std::string name_of_path(const testing::TestParamInfo<std::string>& path) {
    return test_name_of(path.param);
}

bool is_one_line(const std::string& text) {
    return !text.empty() && std::none_of(text.begin(), text.end(), [](unsigned char c) { return c < 0x20; });
}

class BrokenGltf : public testing::TestWithParam<std::string> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(BrokenGltf);

TEST_P(BrokenGltf, IsRefusedAtOnceWithOneLine) {
    const std::filesystem::path file = corpus_folder() / GetParam();
    const Cost cost;
    try {
        const Input input = import_gltf(file);
        ADD_FAILURE() << "was read: " << measure_of(input.scene).triangles << " triangles";
    } catch (const Error& error) {
        EXPECT_TRUE(error.code() == ExitCode::file_error || error.code() == ExitCode::unsupported_input);
        EXPECT_TRUE(is_one_line(error.what())) << error.what();
        EXPECT_NE(std::string(error.what()).find(file.filename().string()), std::string::npos) << error.what();
        RecordProperty("message", error.what());
    }
    EXPECT_LT(cost.seconds(), 1);
    EXPECT_LT(cost.peak_bytes(), 512 * megabyte);
}
INSTANTIATE_TEST_SUITE_P(Corpus, BrokenGltf,
                         testing::ValuesIn(read_list(corpus_folder() / "gltf-bad" / "MUST_REJECT.list")), name_of_path);

class HostileGltf : public testing::TestWithParam<std::string> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(HostileGltf);

TEST_P(HostileGltf, IsReadOrRefused) {
    const Cost cost;
    try {
        const Input input = import_gltf(corpus_folder() / GetParam());
        for (const std::string& warning : input.scene.warnings) EXPECT_TRUE(is_one_line(warning)) << warning;
    } catch (const Error& error) {
        EXPECT_TRUE(is_one_line(error.what())) << error.what();
    }
    EXPECT_LT(cost.peak_bytes(), 512 * megabyte);
}
INSTANTIATE_TEST_SUITE_P(Corpus, HostileGltf,
                         testing::ValuesIn(read_list(corpus_folder() / "gltf-bad" / "NO_CRASH.list")), name_of_path);

/// Files that the makers of the corpus marked: sound ones have to be read, also those with something to warn about.
std::vector<std::string> marked_files(const std::string& mark) {
    std::vector<std::string> files;
    for (const std::string& line : read_list(corpus_folder() / "gltf-bad" / "synthetic" / "MANIFEST.tsv")) {
        const std::size_t tab = line.find('\t');
        if (line.substr(tab + 1, mark.size() + 1) == mark + "\t")
            files.push_back("gltf-bad/synthetic/" + line.substr(0, tab));
    }
    return files;
}

class AcceptedGltf : public testing::TestWithParam<std::string> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(AcceptedGltf);

TEST_P(AcceptedGltf, IsRead) {
    EXPECT_NO_THROW(static_cast<void>(import_gltf(corpus_folder() / GetParam())));
}
INSTANTIATE_TEST_SUITE_P(Corpus, AcceptedGltf, testing::ValuesIn(marked_files("accept")), name_of_path);

class QuestionableGltf : public testing::TestWithParam<std::string> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(QuestionableGltf);

TEST_P(QuestionableGltf, IsReadWithAWarning) {
    try {
        EXPECT_FALSE(import_gltf(corpus_folder() / GetParam()).scene.warnings.empty());
    } catch (const UnsupportedInput& error) {
        // What has to be left out may be all there is.
        EXPECT_THAT(error.what(), testing::HasSubstr("holds neither surface nor points"));
    }
}
INSTANTIATE_TEST_SUITE_P(Corpus, QuestionableGltf, testing::ValuesIn(marked_files("warn")), name_of_path);

}  // namespace
}  // namespace vmap::test
