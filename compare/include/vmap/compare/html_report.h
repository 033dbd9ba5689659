// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A comparison as a page for a browser.
#pragma once

#include <vmap/compare/comparison.h>
#include <vmap/exporters/file_writer.h>

namespace vmap {

/// Writes one HTML file that needs nothing else, no network and no other file: the figures, the histogram of the
/// differences and, for pictures, both under one exposure with a slider between them and a flicker, and maps of the
/// difference and of FLIP with their scales.
///
/// Throws FileError; the caller commits the file.
void write_html_report(FileWriter& file, const Comparison& comparison);

}  // namespace vmap
