// SPDX-License-Identifier: GPL-3.0-or-later
// Every OBJ, PLY, OFF, STL and XYZ file of the corpora: sound ones have the counts that others found, broken ones are
// refused cheaply and in one line, questionable ones are read with a warning.
#include "corpus.h"

#include <vmap/error.h>
#include <vmap/importers/input.h>
#include <vmap/printable.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>
#include <set>
#include <string>
#include <vector>

namespace vmap::test {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t megabyte = 1U << 20U;

class MeshCorpus : public testing::Test {};

TEST_F(MeshCorpus, IsThere) {
    if (!fs::exists(corpus_folder() / "mesh-ok")) GTEST_SKIP() << "the corpus is not at " << corpus_folder();
}

std::size_t triangle_count(const Scene& scene) {
    return std::accumulate(scene.meshes.begin(), scene.meshes.end(), std::size_t{0},
                           [](std::size_t sum, const Mesh& mesh) { return sum + mesh.triangle_count(); });
}

bool is_one_line(const std::string& text) {
    return !text.empty() && std::none_of(text.begin(), text.end(), [](unsigned char c) { return c < 0x20; });
}

std::string name_of_path(const testing::TestParamInfo<std::string>& path) {
    return test_name_of(path.param);
}

class SoundMesh : public testing::TestWithParam<Row> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SoundMesh);

TEST_P(SoundMesh, HasTheExpectedCounts) {
    const Row& row = GetParam();
    const Input input = read_input(corpus_folder() / row.at("path"));
    EXPECT_EQ(std::to_string(input.facts.vertices), row.at("independent_v"));
    EXPECT_EQ(std::to_string(input.facts.polygons), row.at("independent_f"));
    EXPECT_TRUE(triangle_count(input.scene) > 0 || input.points);
    for (const std::string& warning : input.scene.warnings) EXPECT_TRUE(is_one_line(warning)) << warning;
}

std::string name_of_row(const testing::TestParamInfo<Row>& row) {
    return test_name_of(row.param.at("path"));
}
INSTANTIATE_TEST_SUITE_P(Corpus, SoundMesh, testing::ValuesIn(read_table(corpus_folder() / "mesh-ok" / "EXPECT.tsv")),
                         name_of_row);

class BrokenMesh : public testing::TestWithParam<std::string> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(BrokenMesh);

TEST_P(BrokenMesh, IsRefusedAtOnceWithOneLine) {
    const fs::path file = corpus_folder() / GetParam();
    const Cost cost;
    try {
        const Input input = read_input(file);
        ADD_FAILURE() << "was read: " << triangle_count(input.scene) << " triangles";
    } catch (const Error& error) {
        EXPECT_TRUE(error.code() == ExitCode::file_error || error.code() == ExitCode::unsupported_input);
        EXPECT_TRUE(is_one_line(error.what())) << error.what();
        EXPECT_THAT(error.what(), testing::HasSubstr(printable(file.filename().string())));
        RecordProperty("message", error.what());
    }
    EXPECT_LT(cost.seconds(), 1);
    EXPECT_LT(cost.peak_bytes(), 64 * megabyte);
}
INSTANTIATE_TEST_SUITE_P(Corpus, BrokenMesh,
                         testing::ValuesIn(read_list(corpus_folder() / "mesh-bad" / "MUST_REJECT.list")), name_of_path);

class AcceptedMesh : public testing::TestWithParam<std::string> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(AcceptedMesh);

TEST_P(AcceptedMesh, IsRead) {
    const Input input = read_input(corpus_folder() / GetParam());
    EXPECT_TRUE(triangle_count(input.scene) > 0 || input.points);
}
INSTANTIATE_TEST_SUITE_P(Corpus, AcceptedMesh,
                         testing::ValuesIn(read_list(corpus_folder() / "mesh-bad" / "MUST_ACCEPT.list")), name_of_path);

/// Files of the manifest that have to be read with a warning.
std::vector<std::string> questionable_files() {
    std::vector<std::string> files;
    for (const std::string& line : read_list(corpus_folder() / "mesh-bad" / "synthetic" / "MANIFEST.tsv")) {
        const std::size_t tab = line.find('\t');
        if (line.substr(tab + 1, 5) == "warn\t") files.push_back("mesh-bad/synthetic/" + line.substr(0, tab));
    }
    return files;
}

class QuestionableMesh : public testing::TestWithParam<std::string> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(QuestionableMesh);

TEST_P(QuestionableMesh, IsReadWithAWarning) {
    const Input input = read_input(corpus_folder() / GetParam());
    EXPECT_FALSE(input.scene.warnings.empty());
}
INSTANTIATE_TEST_SUITE_P(Corpus, QuestionableMesh, testing::ValuesIn(questionable_files()), name_of_path);

/// Everything in the folder of broken files: also what no list names.
std::vector<std::string> all_files() {
    std::set<std::string> files;
    for (const char* folder : {"mesh-bad/synthetic", "mesh-bad/fuzz-found", "mesh-ok"}) {
        const fs::path root = corpus_folder() / folder;
        if (!fs::exists(root)) continue;
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root))
            if (entry.is_regular_file()) files.insert(fs::relative(entry.path(), corpus_folder()).string());
    }
    return {files.begin(), files.end()};
}

/// Reads a file of any kind without caring for the answer, only for its manners.
void read_politely(const fs::path& file) {
    const Cost cost;
    try {
        const Input input = read_input(file);
        for (const std::string& warning : input.scene.warnings) EXPECT_TRUE(is_one_line(warning)) << warning;
    } catch (const Error& error) {
        EXPECT_TRUE(is_one_line(error.what())) << error.what();
    }
    EXPECT_LT(cost.peak_bytes(), 512 * megabyte) << file;
}

TEST_F(MeshCorpus, EveryFileIsReadOrRefused) {
    for (const std::string& file : all_files()) read_politely(corpus_folder() / file);
}

// The same bytes under the name of every other format reach the other readers.
TEST_F(MeshCorpus, EveryFileIsReadOrRefusedUnderOtherNames) {
    const fs::path folder = fs::path(testing::TempDir()) / "vmap_mesh_corpus";
    fs::create_directories(folder);
    for (const std::string& name : all_files()) {
        const fs::path file = corpus_folder() / name;
        if (fs::file_size(file) > megabyte) continue;
        for (const char* suffix : {".obj", ".ply", ".off", ".stl", ".xyz", ""}) {
            const fs::path renamed = folder / (std::string("file") + suffix);
            fs::copy_file(file, renamed, fs::copy_options::overwrite_existing);
            fs::permissions(renamed, fs::perms::owner_write, fs::perm_options::add);
            read_politely(renamed);
        }
    }
    fs::remove_all(folder);
}

// Cut at every length, a sound file is never read as something else than itself or a shorter sound file.
TEST_F(MeshCorpus, SmallFilesCutAtEveryLengthAreReadOrRefused) {
    const fs::path folder = fs::path(testing::TempDir()) / "vmap_mesh_cut";
    fs::create_directories(folder);
    for (const std::string& name : read_list(corpus_folder() / "mesh-bad" / "MUST_ACCEPT.list")) {
        const fs::path file = corpus_folder() / name;
        if (fs::file_size(file) > 1500) continue;
        std::ifstream stream(file, std::ios::binary);
        const std::string content{std::istreambuf_iterator<char>(stream), {}};
        const fs::path cut = folder / ("cut" + file.extension().string());
        for (std::size_t length = 0; length < content.size(); ++length) {
            std::ofstream(cut, std::ios::binary) << content.substr(0, length);
            read_politely(cut);
        }
    }
    fs::remove_all(folder);
}

}  // namespace
}  // namespace vmap::test
