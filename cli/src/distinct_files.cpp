// SPDX-License-Identifier: GPL-3.0-or-later
#include "distinct_files.h"

#include <vmap/error.h>
#include <vmap/printable.h>

#include <filesystem>
#include <set>

namespace vmap {
namespace {

namespace fs = std::filesystem;

/// One name for all spellings of a path. A path that cannot be followed keeps its own.
std::string identity(const std::string& path) {
    std::error_code error;
    const fs::path followed = fs::weakly_canonical(fs::absolute(path, error), error);
    return error ? path : followed.string();
}

/// Devices and pipes keep nothing that could be lost.
bool keeps_content(const std::string& path) {
    std::error_code error;
    return path != "-" && (!fs::exists(path, error) || fs::is_regular_file(path, error));
}

}  // namespace

void require_distinct_files(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs) {
    std::set<std::string> read;
    for (const std::string& input : inputs)
        if (!input.empty()) read.insert(identity(input));

    std::set<std::string> written;
    for (const std::string& output : outputs) {
        if (output.empty()) continue;
        const std::string name = output == "-" ? output : identity(output);
        if (keeps_content(output) && read.contains(name))
            throw UsageError(printable(output) + ": is an input; expected another name to write to");
        if ((output == "-" || keeps_content(output)) && !written.insert(name).second)
            throw UsageError(printable(output) + ": named twice as an output; expected a name for each");
    }
}

}  // namespace vmap
