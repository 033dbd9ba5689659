// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Irradiance from the OpenVDB grid that the toolkit writes.
#pragma once

#include <Imath/ImathColor.h>
#include <Imath/ImathVec.h>

#include <filesystem>
#include <memory>

namespace vmap::crosscheck {

class VdbIrradiance {
public:
    /// - file: Z up, as our grids are unless told otherwise
    explicit VdbIrradiance(const std::filesystem::path& file);
    ~VdbIrradiance();
    VdbIrradiance(const VdbIrradiance&) = delete;
    VdbIrradiance& operator=(const VdbIrradiance&) = delete;

    /// Interpolated between the voxels about a place of the world.
    [[nodiscard]] Imath::C3f at(const Imath::V3d& position) const;

    [[nodiscard]] double voxel_size() const;

private:
    class Grid;
    std::unique_ptr<Grid> grid_;
};

}  // namespace vmap::crosscheck
