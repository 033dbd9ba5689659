// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The scenes of the cross-check and what is expected of each.
#pragma once

#include <crosscheck/crosscheck.h>
#include <vmap/scene.h>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace vmap::crosscheck {

/// Highest figure that is accepted, as a fraction.
struct Limits {
    double median = 0;
    double p95 = 0;
};

struct Case {
    std::string name;
    std::string scene;                     ///< file in the folder of scenes, or "bunny_room"
    std::string about;                     ///< one line for people
    CrosscheckConfig config;               ///< for the test
    CrosscheckConfig slow;                 ///< for the page
    std::map<std::string, Limits> limits;  ///< of the figures "picture", "ply", "vdb", "ours" and "povray" (the last
                                           ///< two against the truth); what is absent is not judged
};

/// Reads cases.json.
[[nodiscard]] std::vector<Case> read_cases(const std::filesystem::path& file);

/// The scene of a case; nothing where it needs a model that is not there.
/// - scenes, models: folders
[[nodiscard]] std::optional<Scene> scene_of(const Case& item, const std::filesystem::path& scenes,
                                            const std::filesystem::path& models);

/// The figures of a cross-check by the names that limits use.
[[nodiscard]] std::map<std::string, DifferenceFigures> figures_of(const Crosscheck& check);

}  // namespace vmap::crosscheck
