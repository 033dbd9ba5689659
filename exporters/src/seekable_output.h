// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// For libraries that go back in a file to fill in offsets.
#pragma once

#include <vmap/exporters/file_writer.h>

#include <functional>
#include <ostream>

namespace vmap {

/// Calls write with a stream that can seek and throws on failure: the file's own where it can, else one in memory whose
/// content then goes to the file. Either way the bytes are the same.
void write_seekable(FileWriter& file, const std::function<void(std::ostream&)>& write);

}  // namespace vmap
