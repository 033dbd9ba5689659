// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Reference values kept in files, so that the same question is answered once.
#pragma once

#include <reference/reference_tracer.h>

#include <filesystem>
#include <span>
#include <vector>

namespace vmap::reference {

/// What trace_irradiance returns, from a file in the folder when the same scene, points and configuration were traced
/// before; else it is traced and kept there. An empty folder keeps nothing. Files are named after a hash of the content
/// of all that the values depend on; a broken one is made anew.
///
/// Throws FileError when a file cannot be written.
[[nodiscard]] std::vector<ReferenceValue> cached_irradiance(const std::filesystem::path& folder, const Scene& scene,
                                                            std::span<const ReferencePoint> points,
                                                            const ReferenceConfig& config,
                                                            const ProgressCallback& progress = {});

}  // namespace vmap::reference
