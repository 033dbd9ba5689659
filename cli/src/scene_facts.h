// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What vmap info says of a file of meshes or points.
#pragma once

#include <vmap/importers/input.h>

#include <nlohmann/json.hpp>

#include <string>

namespace vmap {

/// What is in a file, what will be used of it and what vmap light would do with it. Lengths, areas and places are in
/// world units, Y up; names are printable.
[[nodiscard]] nlohmann::ordered_json scene_facts(const std::string& file, const Input& input);

}  // namespace vmap
