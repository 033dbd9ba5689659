// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A scene of meshes as a POV-Ray 3.7 scene, for renderings of the same light by another program.
#pragma once

#include <vmap/exporters/output_info.h>
#include <vmap/exporters/picture.h>
#include <vmap/scene.h>

#include <Imath/ImathColor.h>

#include <optional>
#include <string>
#include <vector>

namespace vmap {

/// How much work POV-Ray's radiosity does.
enum class PovPreset {
    draft,     ///< seconds, splotchy
    normal,    ///< 400 rays a sample
    reference  ///< 1600 rays a sample, minutes for a simple room
};

struct PovConfig {
    PovPreset preset = PovPreset::normal;
    std::optional<int> bounces;    ///< reflections and emissive surfaces that count, 0 (no radiosity) to 20; by preset
    bool shading_normals = false;  ///< interpolated normals instead of flat triangles
    std::optional<Camera> camera;  ///< empty: the scene's first, or one that sees everything
    Imath::C3f sky{0, 0, 0};       ///< radiance from beyond the scene, W/(m^2 sr)
    std::optional<Picture> sky_picture;  ///< the same by direction: equirectangular, its centre along +X, its right
                                         ///< half along +Z; takes the place of sky
    int width = 512;                     ///< of the picture in the header's command
    int height = 512;
};

/// What came out of an export.
struct PovExport {
    std::vector<std::string> files;     ///< paths, the scene's first
    std::vector<std::string> warnings;  ///< one line each
};

/// Writes a scene and, beside it, the images that it names. All files appear together, and only when complete.
///
/// Pixels of the rendered picture are radiance in W/(m^2 sr): colours of lights are irradiance / pi. The header holds
/// the command for povray and this table of units. Meshes are declared once and placed by instances; the backs of
/// single-sided surfaces are black and block light; positions keep their right-handed axes, turned so that info.up is
/// up. Scenes smaller than 1 or larger than 10^4 units are scaled by a power of ten (POV-Ray drops intersections nearer
/// than 10^-4), which the header says; radiance does not change.
///
/// Exact in POV-Ray's terms: base colour x texture x vertex colour x (1 - metallic), emission with its texture, point
/// lights and suns, spots with inner = outer cone. Approximate: other spots (POV-Ray's ramp is a cubic), edges of
/// alpha masks (soft over a texel), and materials that combine varying vertex colours with images or images with
/// different texture coordinates, whose colours are written as an image of small tiles, one for each triangle.
///
/// - scene: indices in range, as the importers deliver it
/// - path: ends in .pov by custom; images are named after it
/// - throws FileError; UsageError for a configuration out of range, or for "-" when images are needed;
///   UnsupportedInput for positions, lights or colours that are not finite
PovExport write_pov_scene(const Scene& scene, const std::string& path, const OutputInfo& info,
                          const PovConfig& config = {});

}  // namespace vmap
