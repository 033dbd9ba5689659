// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Which glTF extensions the importer knows, and what it makes of them.
#pragma once

#include <string_view>

namespace vmap::gltf {

enum class ExtensionSupport {
    read,     ///< its meaning is in the Scene
    mapped,   ///< the file is read without it; warning says how
    unknown,  ///< ignored when optional, refused when required
};

struct Extension {
    std::string_view name;
    ExtensionSupport support = ExtensionSupport::unknown;
    std::string_view warning;  ///< for mapped ones; empty when nothing visible is lost
};

[[nodiscard]] Extension find_extension(std::string_view name);

}  // namespace vmap::gltf
