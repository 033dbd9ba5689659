// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What vmap info and vmap compare say of .vmap files.
#pragma once

#include "job.h"

#include <nlohmann/json.hpp>

#include <string>

namespace vmap {

/// Whether a file begins like a .vmap file, of any version.
[[nodiscard]] bool is_vmap_file(const std::string& file);

/// Counts, sizes and seconds of a .vmap file.
[[nodiscard]] nlohmann::ordered_json map_facts(const std::string& file);

/// Compares two .vmap files part by part. Seconds are not compared.
///
/// - returns one entry per part: "same", or how they differ
[[nodiscard]] nlohmann::ordered_json compare_maps(const std::string& file, const std::string& other);

}  // namespace vmap
