// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_folder.h"

#include "content_error.h"

#include <algorithm>
#include <system_error>

namespace vmap {
namespace {

namespace fs = std::filesystem;

/// Checks the text alone, before the file system is asked anything.
void check_relative(std::string_view relative) {
    if (relative.empty()) throw BrokenContent("the name of the file is empty");
    if (relative.find('\0') != std::string_view::npos) throw BrokenContent("the name of the file holds a zero byte");
    const fs::path path(relative);
    if (path.is_absolute()) throw BrokenContent("an absolute path is not opened, expected one relative to the scene");
    if (std::find(path.begin(), path.end(), "..") != path.end())
        throw BrokenContent("a path with '..' is not opened, expected a file inside the scene's folder");
}

bool is_inside(const fs::path& folder, const fs::path& path) {
    return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

}  // namespace

SceneFolder::SceneFolder(const fs::path& scene_file) {
    std::error_code error;
    folder_ = fs::canonical(fs::absolute(scene_file).parent_path(), error);
    if (error) throw BrokenContent("cannot find its folder: " + error.message());
}

fs::path SceneFolder::find(std::string_view relative) const {
    check_relative(relative);
    std::error_code error;
    fs::path path = fs::canonical(folder_ / fs::path(relative), error);
    if (error) throw BrokenContent("cannot open: " + error.message());
    if (!is_inside(folder_, path)) throw BrokenContent("a link out of the scene's folder is not followed");
    return path;
}

}  // namespace vmap
