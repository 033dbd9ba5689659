// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A job must not write over what it reads, nor write one file twice.
#pragma once

#include <string>
#include <vector>

namespace vmap {

/// Checks the files of a job before any is opened. Links and different spellings of one path are seen through; empty
/// names are left out; standard output (-) may be named once.
/// - throws UsageError that names the file
void require_distinct_files(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs);

}  // namespace vmap
