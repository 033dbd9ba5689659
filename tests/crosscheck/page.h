// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The cross-check as one page, and one scene of it as a row of pictures.
#pragma once

#include <crosscheck/cases.h>
#include <vmap/compare/shown_picture.h>

#include <string>
#include <vector>

namespace vmap::crosscheck {

/// The HTML page, built scene by scene. It needs no other file and no network.
class Page {
public:
    /// - item: its slow configuration is what `check` was made with; the truth is that of every pixel
    void add(const Case& item, const Crosscheck& check);

    /// - povray: version
    /// - date: as it is to be shown
    [[nodiscard]] std::string html(const std::string& povray, const std::string& date) const;

private:
    std::vector<std::string> rows_;      ///< of the table of all scenes
    std::vector<std::string> sections_;  ///< one a scene
};

/// Our picture, POV-Ray's, the path tracer's and the errors of the first two side by side; both errors have one scale.
/// - truth at every pixel
[[nodiscard]] ShownPicture picture_row(const Crosscheck& check);

/// Where the scale of the errors ends, as a fraction of the mean of the truth.
[[nodiscard]] double error_scale(const Crosscheck& check);

}  // namespace vmap::crosscheck
