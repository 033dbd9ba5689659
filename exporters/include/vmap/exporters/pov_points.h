// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Lit points as a POV-Ray 3.7 scene that shows them.
#pragma once

#include <vmap/exporters/file_writer.h>
#include <vmap/exporters/output_info.h>
#include <vmap/point_cloud.h>
#include <vmap/progress.h>
#include <vmap/scene.h>

#include <optional>

namespace vmap {

enum class PovPointShape {
    discs,   ///< one-sided, black from behind, raised by a thousandth of their radius so that two sides keep apart
    spheres  ///< seen from everywhere; for clouds without normals
};

struct PovPointsConfig {
    PovPointShape shape = PovPointShape::discs;
    double radius_scale = 1.6;     ///< radius in radii of a point: discs overlap, so that surfaces have no holes
    std::optional<Camera> camera;  ///< empty: one that sees everything
    int width = 512;               ///< of the picture in the header's command
    int height = 512;
};

/// Writes each point as a disc or a sphere that emits the point's radiance and nothing else: pixels of the rendered
/// picture are radiance in W/(m^2 sr); of a cloud without light they are its albedo. Points without an area get the
/// radius that the mean spacing suggests. A point without a normal becomes a sphere.
///
/// Throws FileError, UsageError for a scale that is not positive; the caller commits the file.
void write_pov_points(FileWriter& file, const LitCloud& cloud, const OutputInfo& info,
                      const PovPointsConfig& config = {}, const ProgressCallback& progress = {});

}  // namespace vmap
