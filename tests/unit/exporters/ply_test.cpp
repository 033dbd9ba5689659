// SPDX-License-Identifier: GPL-3.0-or-later
#include "output_folder.h"

#include <vmap/error.h>
#include <vmap/exporters/ply.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <string>

namespace vmap {
namespace {

using testing::HasSubstr;

class PlyFile : public OutputFolder {
protected:
    [[nodiscard]] std::string path() const { return OutputFolder::path("lit.ply"); }
    [[nodiscard]] std::string content() const { return OutputFolder::content("lit.ply"); }
    void write(const LitCloud& cloud, const OutputInfo& info = {}) const {
        FileWriter file(path());
        write_ply(file, cloud, info);
        file.commit();
    }
};

TEST_F(PlyFile, HeaderNamesEveryPropertyOfTheContract) {
    write(two_points(), {.up = UpAxis::z, .source = "room.glb"});
    const std::string text = content();
    EXPECT_THAT(text, testing::StartsWith("ply\nformat binary_little_endian 1.0\n"));
    for (const char* line : {"comment up z\n", "comment source room.glb\n", "element vertex 2\n", "property float x\n",
                             "property float nx\n", "property uchar red\n", "property float irradiance_r\n",
                             "property float albedo_b\n", "property float radius\n", "property float area\n"})
        EXPECT_THAT(text, HasSubstr(line));
    EXPECT_THAT(text, testing::Not(HasSubstr("emission_r")));
}

TEST_F(PlyFile, HoldsWhatTheHeaderPromisesAndKeepsHdr) {
    write(two_points());
    const std::string text = content();
    const std::string end = "end_header\n";
    const std::size_t data = text.find(end) + end.size();
    EXPECT_EQ((text.size() - data) % 2, 0U);
    const float hdr = 1e4F;
    std::string bytes(sizeof(hdr), '\0');
    std::memcpy(bytes.data(), &hdr, sizeof(hdr));
    EXPECT_NE(text.find(bytes, data), std::string::npos);
}

TEST_F(PlyFile, UncommittedFileLeavesNothingAndTheOldOneAlone) {
    write(two_points());
    const std::string before = content();
    {
        FileWriter file(path());
        file.write("torn", 4);
    }
    EXPECT_EQ(content(), before);
    EXPECT_EQ(file_count(), 1U);
}

TEST_F(PlyFile, UnwritableFolderIsAFileError) {
    EXPECT_THROW(FileWriter((folder / "absent" / "lit.ply").string()), FileError);
}

TEST_F(PlyFile, NoPointsIsAValidFile) {
    write({});
    EXPECT_THAT(content(), HasSubstr("element vertex 0\n"));
}

}  // namespace
}  // namespace vmap
