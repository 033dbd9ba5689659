// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A second reader of the toolkit's own PLY files, written from their documentation alone: what the writer or the
/// importer get wrong does not cancel here.
#pragma once

#include <Imath/ImathColor.h>
#include <Imath/ImathVec.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace vmap::reference {

/// The points of a file in the world frame of the scene: Y up, offset added.
struct LitPly {
    std::vector<Imath::V3d> positions;
    std::vector<Imath::V3d> normals;
    std::vector<Imath::C3f> irradiance;
    std::vector<Imath::C3f> albedo;
    std::vector<Imath::C3f> emission;  ///< empty where the file has none
    std::vector<double> areas;
    std::vector<std::uint32_t> faces;
    std::map<std::string, std::string> comments;  ///< what follows the first word of each comment of the header

    [[nodiscard]] std::size_t size() const { return positions.size(); }
};

/// Throws FileError for a file that is not a binary little-endian PLY with the properties of a lit cloud.
[[nodiscard]] LitPly read_lit_ply(const std::filesystem::path& file);

}  // namespace vmap::reference
