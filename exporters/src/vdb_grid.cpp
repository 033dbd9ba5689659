// SPDX-License-Identifier: GPL-3.0-or-later
#include "file_points.h"
#include "vdb_archive.h"

#include <vmap/error.h>
#include <vmap/exporters/vdb_grid.h>
#include <vmap/printable.h>

#include <fmt/format.h>
#include <openvdb/tools/Morphology.h>
#include <openvdb/tree/LeafManager.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace vmap {
namespace {

using openvdb::Coord;
using openvdb::Vec3s;

constexpr double voxels_per_spacing_limit = 8;

double voxel_size_of(const PointCloud& cloud, const VdbGridConfig& config, const std::string& path) {
    const double size = config.voxel_size;
    if (size == 0) return default_voxel_size(cloud);
    if (!(size > 0) || !std::isfinite(size))
        throw UsageError(fmt::format("{}: voxel size {}, expected a positive number", printable(path), size));
    const double least = mean_spacing(cloud) / voxels_per_spacing_limit;
    if (size < least)
        throw UsageError(fmt::format("{}: voxel size {}, expected at least {} (an eighth of the points' spacing)",
                                     printable(path), size, least));
    return size;
}

/// A point and the voxel that holds it.
struct PointVoxel {
    Coord voxel;
    std::uint32_t point;
    friend bool operator<(const PointVoxel& a, const PointVoxel& b) {
        return a.voxel != b.voxel ? a.voxel < b.voxel : a.point < b.point;
    }
};

/// All points, sorted by voxel.
std::vector<PointVoxel> voxels_of(const FilePoints& points, std::size_t count, double voxel_size,
                                  const std::string& path) {
    constexpr double index_limit = 1 << 30;
    std::vector<PointVoxel> voxels(count);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        const Imath::V3d index = Imath::V3d(points.position(i)) / voxel_size;
        for (int axis = 0; axis < 3; ++axis)
            if (!(std::abs(index[axis]) < index_limit))
                throw UsageError(fmt::format("{}: voxel size {} is too small for a cloud of this extent",
                                             printable(path), voxel_size));
        voxels[i] = {Coord::round(openvdb::Vec3d(index.x, index.y, index.z)), static_cast<std::uint32_t>(i)};
    });
    tbb::parallel_sort(voxels.begin(), voxels.end());
    return voxels;
}

/// Mean of E over the points of one voxel, weighted by area.
Vec3s mean_irradiance(const LitCloud& cloud, std::span<const PointVoxel> voxel) {
    Imath::V3d weighted(0), plain(0);
    double area = 0;
    for (const PointVoxel& entry : voxel) {
        const Imath::V3d irradiance(cloud.irradiance[entry.point]);
        const double weight = cloud.points.areas.empty() ? 1 : cloud.points.areas[entry.point];
        weighted += irradiance * weight;
        plain += irradiance;
        area += weight;
    }
    const Imath::V3d mean = area > 0 ? weighted / area : plain / static_cast<double>(voxel.size());
    return Vec3s(openvdb::Vec3d(mean.x, mean.y, mean.z));
}

void fill(openvdb::FloatGrid& density, openvdb::Vec3SGrid* irradiance, const LitCloud& cloud,
          std::span<const PointVoxel> points) {
    auto density_at = density.getAccessor();
    std::optional<openvdb::Vec3SGrid::Accessor> irradiance_at;
    if (irradiance != nullptr) irradiance_at.emplace(irradiance->getAccessor());
    for (std::size_t begin = 0, end = 0; begin < points.size(); begin = end) {
        const Coord voxel = points[begin].voxel;
        while (end < points.size() && points[end].voxel == voxel) ++end;
        density_at.setValueOn(voxel, 1.0F);
        if (irradiance_at) irradiance_at->setValueOn(voxel, mean_irradiance(cloud, points.subspan(begin, end - begin)));
    }
}

/// Gives each inactive voxel that touches an active one the mean of those that it touches.
void extend_by_one_voxel(openvdb::Vec3SGrid& grid) {
    const openvdb::Vec3STree before(grid.constTree());
    openvdb::tools::dilateActiveValues(grid.tree(), 1, openvdb::tools::NN_FACE_EDGE_VERTEX,
                                       openvdb::tools::IGNORE_TILES);
    openvdb::tree::LeafManager<openvdb::Vec3STree> leaves(grid.tree());
    leaves.foreach ([&](openvdb::Vec3STree::LeafNodeType& leaf, std::size_t) {
        const openvdb::tree::ValueAccessor<const openvdb::Vec3STree> before_at(before);
        for (auto value = leaf.beginValueOn(); value; ++value) {
            const Coord center = value.getCoord();
            if (before_at.isValueOn(center)) continue;
            openvdb::Vec3d sum(0.0);
            int count = 0;
            for (int neighbour = 0; neighbour < 27; ++neighbour) {
                const Coord step(neighbour % 3 - 1, neighbour / 3 % 3 - 1, neighbour / 9 - 1);
                Vec3s touched;
                if (!before_at.probeValue(center + step, touched)) continue;
                sum += touched;
                ++count;
            }
            value.setValue(Vec3s(sum / count));
        }
    });
}

}  // namespace

double default_voxel_size(const PointCloud& cloud) {
    const double spacing = mean_spacing(cloud);
    return spacing > 0 ? 2 * spacing : 1;
}

void write_vdb_grid(FileWriter& file, const LitCloud& cloud, const OutputInfo& info, const VdbGridConfig& config,
                    const ProgressCallback& progress) {
    openvdb::initialize();
    const FilePoints points(cloud.points, info.up);
    const double voxel_size = voxel_size_of(cloud.points, config, file.path());
    const auto transform = voxel_transform(voxel_size, points.offset());
    const bool lit = !cloud.irradiance.empty();

    // A grid without a leaf node renders black in Cycles.
    const auto density = openvdb::FloatGrid::create(0.0F);
    density->tree().touchLeaf(Coord(0));
    openvdb::Vec3SGrid::Ptr irradiance = lit ? openvdb::Vec3SGrid::create(Vec3s(0)) : nullptr;
    if (lit) irradiance->tree().touchLeaf(Coord(0));

    report_progress(progress, "write", 0);
    fill(*density, irradiance.get(), cloud, voxels_of(points, cloud.points.size(), voxel_size, file.path()));
    report_progress(progress, "write", 0.3);
    for (int i = 0; lit && i < 2; ++i) extend_by_one_voxel(*irradiance);
    report_progress(progress, "write", 0.7);

    openvdb::GridCPtrVec grids;
    density->setTransform(transform);
    density->setGridClass(openvdb::GRID_FOG_VOLUME);
    describe_grid(*density, "density", info, points.offset());
    grids.push_back(density);
    if (lit) {
        irradiance->setTransform(transform);
        irradiance->setGridClass(openvdb::GRID_FOG_VOLUME);
        irradiance->setVectorType(openvdb::VEC_INVARIANT);
        describe_grid(*irradiance, "irradiance", info, points.offset());
        irradiance->insertMeta("units", openvdb::StringMetadata("W/m^2"));
        grids.push_back(irradiance);
    }
    write_vdb(file, grids, cloud, info, fmt::format("grid {}", voxel_size));
    report_progress(progress, "write", 1);
}

}  // namespace vmap
