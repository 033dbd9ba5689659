// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Which format a file is of.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace vmap {

enum class InputFormat { gltf, obj, ply, off, stl, xyz, vmap };

/// The name of a format as people know it.
[[nodiscard]] std::string_view name_of(InputFormat format);

/// Looks at the content first and at the name only where the content could be several things.
///
/// - content: the start of the file, some kilobytes
/// - size: of the whole file in bytes
/// - name: of the file
/// - throws UnsupportedContent for a format that is not read, BrokenContent when the name says one format and the
/// content
///   another
[[nodiscard]] InputFormat recognize_format(std::string_view content, std::uint64_t size,
                                           const std::filesystem::path& name);

}  // namespace vmap
