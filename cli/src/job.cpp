// SPDX-License-Identifier: GPL-3.0-or-later
#include "job.h"

#include <vmap/printable.h>

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace vmap {
namespace {

ProgressOptions progress_options(const CommonOptions& options) {
    const bool terminal = ::isatty(STDERR_FILENO) == 1;
    return {.bar = terminal && !options.quiet,
            .lines = !terminal && options.verbose && !options.quiet,
            .file = options.progress_file};
}

}  // namespace

Job::Job(const CommonOptions& options, Interruption& interruption)
    : options_(options), interruption_(interruption), display_(progress_options(options), interruption) {}

void Job::warn(const std::string& warning) {
    if (!told_.insert(warning).second) return;
    warnings_.push_back(printable(warning));
    if (options_.quiet) return;
    display_.clear();
    fmt::print(stderr, "vmap: warning: {}\n", warnings_.back());
}

void Job::warn(const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings) warn(warning);
}

void Job::tell(const std::string& line) {
    if (!options_.verbose || options_.quiet) return;
    display_.clear();
    fmt::print(stderr, "vmap: {}\n", printable(line));
}

void add_common_options(CLI::App& app, CommonOptions& options) {
    app.add_option("--threads", options.threads, "Threads to use; 0: one per core. The result does not depend on it")
        ->check(CLI::Range(0, 1024))
        ->type_name("N");
    app.add_option("--seed", options.seed, "Seed of everything random; same seed, same bytes")->type_name("N");
    app.add_flag("--quiet", options.quiet, "No warnings and no progress");
    app.add_flag("-v,--verbose", options.verbose, "Say what is done and what was skipped");
    app.add_option("--progress", options.progress_file, "Report progress there, one JSON object per line")
        ->type_name("FILE");
}

}  // namespace vmap
