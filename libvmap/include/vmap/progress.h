// SPDX-License-Identifier: Apache-2.0
/// \file
/// How long work tells where it stands, and how it is stopped.
#pragma once

#include <functional>
#include <string_view>

namespace vmap {

/// Called now and then during long work with the name of the stage and the fraction of it that is done, in [0, 1].
/// It may be called from any thread that the library uses, one call at a time. To stop the work throw from it: the
/// exception leaves the function that was given the callback. An empty callback is never called.
using ProgressCallback = std::function<void(std::string_view stage, double fraction)>;

inline void report_progress(const ProgressCallback& progress, std::string_view stage, double fraction) {
    if (progress) progress(stage, fraction);
}

}  // namespace vmap
