// SPDX-License-Identifier: GPL-3.0-or-later
#include "progress_display.h"

#include <vmap/error.h>
#include <vmap/printable.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <system_error>

namespace vmap {
namespace {

using namespace std::chrono_literals;

constexpr auto least_pause = 100ms;  ///< between two pictures of the bar

/// Stages in the order of a whole job, with the share of its time by which each has ended, roughly.
struct Stage {
    std::string_view name;
    double begin;
    double end;
};
constexpr std::array stages{Stage{"import", 0, 0.08},     Stage{"sample", 0.08, 0.2},  Stage{"prepare", 0.08, 0.2},
                            Stage{"tree", 0.2, 0.3},      Stage{"vmap", 0.3, 0.35},    Stage{"direct", 0.3, 0.6},
                            Stage{"indirect", 0.6, 0.85}, Stage{"picture", 0.85, 0.9}, Stage{"write", 0.9, 1.0}};

}  // namespace

ProgressDisplay::ProgressDisplay(const ProgressOptions& options, const Interruption& interruption)
    : options_(options), interruption_(interruption) {
    if (options_.file.empty()) return;
    file_.open(options_.file);
    if (!file_)
        throw FileError(printable(options_.file) + ": cannot open: " + std::generic_category().message(errno) +
                        "; expected a file to report progress to");
}

ProgressDisplay::~ProgressDisplay() {
    clear();
}

ProgressCallback ProgressDisplay::callback() {
    return [this](std::string_view stage, double fraction) {
        interruption_.check();
        show(stage, fraction);
    };
}

void ProgressDisplay::clear() {
    const std::lock_guard lock(mutex_);
    if (bar_drawn_) fmt::print(stderr, "\r\x1b[K");
    bar_drawn_ = false;
}

void ProgressDisplay::show(std::string_view stage, double fraction) {
    if (!options_.bar && !options_.lines && options_.file.empty()) return;
    const std::lock_guard lock(mutex_);
    const auto now = std::chrono::steady_clock::now();
    const bool new_stage = stage != last_stage_;
    if (!new_stage && now - last_shown_ < least_pause && fraction < 1) return;
    last_shown_ = now;
    last_stage_ = stage;

    const auto known = std::find_if(stages.begin(), stages.end(), [&](const Stage& s) { return s.name == stage; });
    if (known != stages.end()) overall_ = std::max(overall_, known->begin + (known->end - known->begin) * fraction);
    const double seconds = std::chrono::duration<double>(now - start_).count();
    if (options_.bar) draw_bar(stage, overall_, seconds);
    if (options_.lines && new_stage) fmt::print(stderr, "vmap: {} ({:.2f} s)\n", stage, seconds);
    if (file_.is_open()) {
        file_ << fmt::format(R"({{"stage": "{}", "fraction": {:.4f}, "overall": {:.4f}, "seconds": {:.3f}}})", stage,
                             fraction, overall_, seconds)
              << std::endl;  // a reader waits for the line
    }
}

void ProgressDisplay::draw_bar(std::string_view stage, double overall, double seconds) {
    constexpr int width = 30;
    const int filled = static_cast<int>(overall * width);
    std::string left = overall > 0.05 ? fmt::format(", {:.0f} s left", seconds * (1 - overall) / overall) : "";
    fmt::print(stderr, "\r\x1b[K[{:#<{}}{: <{}}] {:3.0f} % {}{}", "", filled, "", width - filled, overall * 100, stage,
               left);
    std::fflush(stderr);
    bar_drawn_ = true;
}

}  // namespace vmap
