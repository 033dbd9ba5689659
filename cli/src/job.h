// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What all sub-commands share: the options every one of them has, and how they talk to the user.
#pragma once

#include "interruption.h"
#include "progress_display.h"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace vmap {

struct CommonOptions {
    int threads = 0;  ///< 0: one per core
    std::uint64_t seed = 1;
    bool quiet = false;
    bool verbose = false;
    std::string progress_file;
};

/// One run of a sub-command.
class Job {
public:
    Job(const CommonOptions& options, Interruption& interruption);

    [[nodiscard]] const CommonOptions& options() const { return options_; }
    [[nodiscard]] Interruption& interruption() { return interruption_; }
    [[nodiscard]] ProgressCallback progress() { return display_.callback(); }

    /// Says it once on standard error unless --quiet, and keeps it for the report.
    void warn(const std::string& warning);
    void warn(const std::vector<std::string>& warnings);
    [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

    /// A line on standard error for -v.
    void tell(const std::string& line);

private:
    const CommonOptions& options_;
    Interruption& interruption_;
    ProgressDisplay display_;
    std::vector<std::string> warnings_;
    std::set<std::string> told_;
};

/// A sub-command: the parser fills what `run` then works on.
struct Command {
    CLI::App* app = nullptr;
    std::function<void(Job&)> run;
};

/// Options that every sub-command has.
void add_common_options(CLI::App& app, CommonOptions& options);

}  // namespace vmap
