// SPDX-License-Identifier: GPL-3.0-or-later
#include "warnings.h"

#include <vmap/printable.h>

#include <fmt/format.h>

#include <algorithm>

namespace vmap {

void Warnings::add(const std::string& feature, const std::string& example) {
    const auto known =
        std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) { return entry.feature == feature; });
    if (known != entries_.end())
        ++known->count;
    else
        entries_.push_back({feature, example, 1});
}

std::vector<std::string> Warnings::lines() const {
    std::vector<std::string> lines;
    lines.reserve(entries_.size());
    for (const Entry& entry : entries_) {
        std::string line = entry.feature;
        if (!entry.example.empty() && entry.count > 1)
            line += fmt::format(" ({} and {} more)", entry.example, entry.count - 1);
        else if (!entry.example.empty())
            line += fmt::format(" ({})", entry.example);
        lines.push_back(printable(line));
    }
    return lines;
}

}  // namespace vmap
