// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Options whose value is one of a few words.
#pragma once

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <map>
#include <string>

namespace vmap {

/// For Option::transform: the word becomes the number that it stands for; any other word is refused with the list.
template <class Value>
[[nodiscard]] CLI::Validator choice(const std::map<std::string, Value>& values) {
    std::string words;
    for (const auto& [word, value] : values) words += (words.empty() ? "" : ", ") + word;
    return {[values, words](std::string& text) {
                const auto found = values.find(text);
                if (found == values.end()) return fmt::format("'{}' is not known; expected one of {}", text, words);
                text = std::to_string(static_cast<int>(found->second));
                return std::string();
            },
            ""};
}

}  // namespace vmap
