// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What is wrong inside a file, told by code that does not know the file's name. Each importer catches these once, puts
/// the name in front and throws FileError or UnsupportedInput.
#pragma once

#include <stdexcept>
#include <string>

namespace vmap {

/// The content breaks its format: "accessors[3].count is -1, expected an integer from 1".
class BrokenContent : public std::runtime_error {
public:
    explicit BrokenContent(const std::string& message) : std::runtime_error(message) {}
};

/// The content is sound, but the toolkit does not read it.
class UnsupportedContent : public std::runtime_error {
public:
    explicit UnsupportedContent(const std::string& message) : std::runtime_error(message) {}
};

}  // namespace vmap
