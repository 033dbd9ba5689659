// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A loop over points on all threads.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstddef>
#include <functional>

namespace vmap {

/// Called now and then from any thread during long work; what it throws ends the work. May be empty.
using Watch = std::function<void()>;

/// Calls function(i) for every point; calls for different points must not touch the same data.
template <class Function>
void for_each_point(std::size_t count, const Watch& watch, const Function& function) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 512),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                          if (watch) watch();
                          for (std::size_t i = range.begin(); i < range.end(); ++i) function(i);
                      });
}

}  // namespace vmap
