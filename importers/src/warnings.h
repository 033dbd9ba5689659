// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Warnings of an importer: one line per feature, however often the feature occurs.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace vmap {

class Warnings {
public:
    /// Counts one occurrence of a feature.
    ///
    /// - feature: the warning's text, the same at every occurrence
    /// - example: where it was met; the first one is told. May be empty.
    void add(const std::string& feature, const std::string& example = {});

    /// One printable line per feature in the order of first occurrence: "feature (example and 3 more)".
    [[nodiscard]] std::vector<std::string> lines() const;

private:
    struct Entry {
        std::string feature;
        std::string example;
        std::size_t count = 0;
    };
    std::vector<Entry> entries_;
};

}  // namespace vmap
