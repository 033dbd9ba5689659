// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How a user sees where long work stands: a bar on a terminal, lines with -v, and a file of JSON objects for programs.
#pragma once

#include "interruption.h"

#include <vmap/progress.h>

#include <chrono>
#include <fstream>
#include <mutex>
#include <string>
#include <string_view>

namespace vmap {

struct ProgressOptions {
    bool bar = false;    ///< standard error is a terminal and nothing was said against it
    bool lines = false;  ///< one line per stage on standard error
    std::string file;    ///< one JSON object per line: stage, fraction, overall, seconds; empty: none
};

class ProgressDisplay {
public:
    /// - throws FileError when the file cannot be opened
    ProgressDisplay(const ProgressOptions& options, const Interruption& interruption);
    ~ProgressDisplay();
    ProgressDisplay(const ProgressDisplay&) = delete;
    ProgressDisplay& operator=(const ProgressDisplay&) = delete;

    /// For the library; throws Interrupted after a signal.
    [[nodiscard]] ProgressCallback callback();

    /// Takes the bar off the terminal so that other text can be written.
    void clear();

private:
    void show(std::string_view stage, double fraction);
    void draw_bar(std::string_view stage, double overall, double seconds);

    ProgressOptions options_;
    const Interruption& interruption_;
    std::ofstream file_;
    std::mutex mutex_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    std::chrono::steady_clock::time_point last_shown_;
    std::string last_stage_;
    double overall_ = 0;
    bool bar_drawn_ = false;
};

}  // namespace vmap
