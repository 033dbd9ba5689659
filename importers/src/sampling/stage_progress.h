// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Progress of one stage of a job as a part of the whole, told from any thread.
#pragma once

#include <vmap/progress.h>

#include <cstddef>
#include <mutex>

namespace vmap {

/// Keeps a reference to the callback. What the callback throws leaves the calling function.
class StageProgress {
public:
    /// - begin, end: fractions of the job where the stage begins and ends
    /// - steps: of the stage
    StageProgress(const ProgressCallback& callback, double begin, double end, std::size_t steps)
        : callback_(callback), begin_(begin), width_(end - begin), steps_(steps) {
        report_progress(callback_, "sample", begin_);
    }

    /// Counts steps that are done.
    void advance(std::size_t steps = 1) {
        if (!callback_ || steps_ == 0) return;
        const std::lock_guard lock(mutex_);
        done_ += steps;
        callback_("sample", begin_ + width_ * static_cast<double>(done_) / static_cast<double>(steps_));
    }

private:
    const ProgressCallback& callback_;
    double begin_;
    double width_;
    std::size_t steps_;
    std::size_t done_ = 0;
    std::mutex mutex_;
};

}  // namespace vmap
