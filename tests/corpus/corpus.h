// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The corpora beside the repository: their lists, and what reading one of their files cost.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace vmap::test {

/// The folder of the corpora; it may be absent.
[[nodiscard]] std::filesystem::path corpus_folder();

/// Lines of a list; none when the file is absent.
[[nodiscard]] std::vector<std::string> read_list(const std::filesystem::path& file);

/// Rows of a table with a header line; none when the file is absent.
using Row = std::map<std::string, std::string>;
[[nodiscard]] std::vector<Row> read_table(const std::filesystem::path& file);

/// Numbers between blanks.
[[nodiscard]] std::vector<double> numbers_in(const std::string& text);

/// A name that a test may have: letters, digits and underscores.
[[nodiscard]] std::string test_name_of(const std::string& path);

/// Time and memory since its construction.
class Cost {
public:
    Cost();
    [[nodiscard]] double seconds() const;
    /// Growth of the largest memory in use. Nothing is known, and 0 returned, where the system does not tell it and
    /// under sanitizers, whose own memory would count.
    [[nodiscard]] std::size_t peak_bytes() const;

private:
    double start_;
    std::size_t start_bytes_;
};

}  // namespace vmap::test
