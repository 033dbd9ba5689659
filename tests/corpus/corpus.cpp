// SPDX-License-Identifier: GPL-3.0-or-later
#include "corpus.h"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <fstream>
#include <iterator>
#include <sstream>

namespace vmap::test {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool sanitized = true;
#else
constexpr bool sanitized = false;
#endif

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// A line of /proc/self/status in bytes.
std::size_t status_bytes(const std::string& key) {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with(key + ":")) return std::stoull(line.substr(key.size() + 1)) * 1024;
    return 0;
}

std::vector<std::string> split(const std::string& line, char separator) {
    std::vector<std::string> parts;
    std::istringstream stream(line);
    for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
    return parts;
}

}  // namespace

std::filesystem::path corpus_folder() {
    return std::filesystem::path(VMAP_SHARED) / "corpus";
}

std::vector<std::string> read_list(const std::filesystem::path& file) {
    std::vector<std::string> lines;
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);)
        if (!line.empty()) lines.push_back(line);
    return lines;
}

std::vector<Row> read_table(const std::filesystem::path& file) {
    const std::vector<std::string> lines = read_list(file);
    std::vector<Row> rows;
    if (lines.empty()) return rows;
    const std::vector<std::string> keys = split(lines.front(), '\t');
    for (std::size_t i = 1; i < lines.size(); ++i) {
        const std::vector<std::string> values = split(lines[i], '\t');
        Row& row = rows.emplace_back();
        for (std::size_t k = 0; k < keys.size(); ++k) row[keys[k]] = k < values.size() ? values[k] : "";
    }
    return rows;
}

std::vector<double> numbers_in(const std::string& text) {
    std::istringstream stream(text);
    return {std::istream_iterator<double>(stream), {}};
}

std::string test_name_of(const std::string& path) {
    std::string name = path;
    std::replace_if(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
    return name;
}

Cost::Cost() : start_(now()) {
    std::ofstream("/proc/self/clear_refs") << 5;  // the peak starts again at what is in use
    start_bytes_ = status_bytes("VmRSS");
}

double Cost::seconds() const {
    return now() - start_;
}

std::size_t Cost::peak_bytes() const {
    const std::size_t peak = status_bytes("VmHWM");
    return sanitized || peak < start_bytes_ ? 0 : peak - start_bytes_;
}

}  // namespace vmap::test
