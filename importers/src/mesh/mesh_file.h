// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the readers of mesh and point formats deliver.
#pragma once

#include "../warnings.h"
#include "polygon_soup.h"

#include <vmap/axes.h>
#include <vmap/importers/input.h>
#include <vmap/scene.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace vmap {

struct MeshFile {
    std::string format;        ///< for people: "PLY, binary little-endian"
    UpAxis up = UpAxis::z;     ///< of the file
    std::size_t polygons = 0;  ///< that the file itself counts; strips are none
    PolygonSoup soup;
    std::vector<Material> materials;  ///< empty: default_material() for all
    std::vector<Image> images;
    std::optional<PointFile> points;  ///< a file of points that tells more than a soup holds; in the axes of the file
    Warnings warnings;
};

/// What the toolkit assumes of a surface without any material: a light grey, as most modelling programs do.
inline constexpr float default_albedo = 0.8F;

}  // namespace vmap
