// SPDX-License-Identifier: GPL-3.0-or-later
#include "output_folder.h"

#include <vmap/error.h>
#include <vmap/exporters/exr.h>
#include <vmap/exporters/gltf_points.h>
#include <vmap/exporters/ply.h>
#include <vmap/exporters/png.h>
#include <vmap/exporters/vdb_grid.h>
#include <vmap/exporters/vdb_points.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <functional>
#include <string>

namespace vmap {
namespace {

using testing::HasSubstr;

Picture noise(int side) {
    Picture picture;
    picture.width = picture.height = side;
    std::uint32_t state = 1;
    for (int i = 0; i < side * side; ++i) {
        state = state * 1664525U + 1013904223U;
        picture.pixels.emplace_back(static_cast<float>(state >> 8) * 0x1p-24F, 0.5F, 0.25F);
    }
    return picture;
}

struct Format {
    std::string name;
    std::function<void(FileWriter&)> write;
};

std::vector<Format> formats() {
    return {
        {"ply", [](FileWriter& file) { write_ply(file, floor_points(100), {}); }},
        {"glb", [](FileWriter& file) { write_gltf_points(file, floor_points(100), {}); }},
        {"gltf",
         [](FileWriter& file) {
             write_gltf_points(file, floor_points(100), {}, {.container = GltfContainer::embedded});
         }},
        {"vdb", [](FileWriter& file) { write_vdb_grid(file, floor_points(100), {}); }},
        {"points.vdb", [](FileWriter& file) { write_vdb_points(file, floor_points(100), {}); }},
        {"exr", [](FileWriter& file) { write_exr(file, noise(200), {}); }},
        {"png", [](FileWriter& file) { write_png(file, noise(200), {}); }},
    };
}

std::string error_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const FileError& error) {
        return error.what();
    }
    return "no error";
}

/// Files may not grow beyond a size; as on a full disk, a write then fails.
class SizeLimit {
public:
    explicit SizeLimit(rlim_t bytes) {
        ::getrlimit(RLIMIT_FSIZE, &before_);
        rlimit limit = before_;
        limit.rlim_cur = bytes;
        ::setrlimit(RLIMIT_FSIZE, &limit);
        handler_ = std::signal(SIGXFSZ, SIG_IGN);
    }
    ~SizeLimit() {
        ::setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }
    SizeLimit(const SizeLimit&) = delete;
    SizeLimit& operator=(const SizeLimit&) = delete;

private:
    rlimit before_{};
    void (*handler_)(int) = nullptr;
};

class FullDisk : public OutputFolder {};

TEST_F(FullDisk, IsAnErrorInEveryFormat) {
    for (const Format& format : formats()) {
        SCOPED_TRACE(format.name);
        const std::string error = error_of([&] {
            FileWriter file("/dev/full");
            format.write(file);
            file.commit();
        });
        EXPECT_THAT(error, HasSubstr("/dev/full: cannot write: No space left on device"));
    }
}

TEST_F(FullDisk, LeavesTheOldFileAloneAndNothingElse) {
    for (const Format& format : formats()) {
        SCOPED_TRACE(format.name);
        const std::string name = "lit." + format.name;
        std::ofstream(path(name)) << "old";
        const std::string error = error_of([&] {
            const SizeLimit limit(20000);
            FileWriter file(path(name));
            format.write(file);
            file.commit();
        });
        EXPECT_THAT(error, HasSubstr(path(name) + ": cannot write: File too large"));
        EXPECT_EQ(content(name), "old");
        std::filesystem::remove(path(name));
        EXPECT_EQ(file_count(), 0U);
    }
}

TEST_F(FullDisk, StandardOutputGetsTheSameBytesAsAFile) {
    for (const Format& format : formats()) {
        SCOPED_TRACE(format.name);
        FileWriter file(path("file"));
        format.write(file);
        file.commit();

        const int saved = ::dup(STDOUT_FILENO);
        ASSERT_NE(std::freopen(path("stdout").c_str(), "wb", stdout), nullptr);
        FileWriter standard_output("-");
        format.write(standard_output);
        standard_output.commit();
        ::dup2(saved, STDOUT_FILENO);
        ::close(saved);
        EXPECT_TRUE(content("file") == content("stdout"));
    }
}

}  // namespace
}  // namespace vmap
