// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Files that a scene file refers to, and the only way to open them.
#pragma once

#include <filesystem>
#include <string_view>

namespace vmap {

/// The folder of a scene file. What the file names is opened only if it is a regular file inside this folder.
class SceneFolder {
public:
    /// - scene_file: an existing file
    explicit SceneFolder(const std::filesystem::path& scene_file);

    /// The file that the scene names by a relative path, ready for read_file.
    ///
    /// - relative: UTF-8 with '/' between folders; not absolute and without ".."; links may not lead out of the folder
    /// - throws BrokenContent; the message does not repeat the name
    [[nodiscard]] std::filesystem::path find(std::string_view relative) const;

private:
    std::filesystem::path folder_;  // without links, so that it can be compared
};

}  // namespace vmap
