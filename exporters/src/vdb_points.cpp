// SPDX-License-Identifier: GPL-3.0-or-later
#include "file_points.h"
#include "vdb_archive.h"

#include <vmap/exporters/vdb_points.h>

#include <openvdb/points/PointConversion.h>

#include <cmath>
#include <utility>

namespace vmap {
namespace {

using openvdb::Vec3f;

/// Values of the points as OpenVDB asks for them, computed one by one.
template <class Value, class Function>
class Computed {
public:
    using PosType = Value;
    using value_type = Value;

    Computed(std::size_t size, Function function) : size_(size), function_(std::move(function)) {}

    // The names are OpenVDB's.
    [[nodiscard]] std::size_t size() const { return size_; }
    void getPos(std::size_t i, Value& value) const { value = function_(i); }               // NOLINT
    void get(Value& value, std::size_t i) const { value = function_(i); }                  // NOLINT
    void get(Value& value, std::size_t i, openvdb::Index) const { value = function_(i); }  // NOLINT

private:
    std::size_t size_;
    Function function_;
};

template <class Value, class Function>
Computed<Value, Function> computed(std::size_t size, Function function) {
    return {size, std::move(function)};
}

/// About 16 points of a surface share a voxel, and 1000 a leaf node.
double voxel_size_for_points(const PointCloud& cloud) {
    const double spacing = mean_spacing(cloud);
    double largest = 0;
    for (const Imath::V3f& position : cloud.positions)
        for (int axis = 0; axis < 3; ++axis) largest = std::max(largest, std::abs(static_cast<double>(position[axis])));
    constexpr double index_limit = 1 << 28;  // of the 32 bits that OpenVDB has, with room for the offset
    return std::max(spacing > 0 ? 4 * spacing : 1, 2 * largest / index_limit);
}

class Attributes {
public:
    Attributes(openvdb::points::PointDataGrid& grid, const openvdb::tools::PointIndexGrid& index, std::size_t count)
        : grid_(grid), index_(index), count_(count) {}

    template <class Value, class Function>
    void add(const char* name, Function function) const {
        using Array = openvdb::points::TypedAttributeArray<Value>;
        openvdb::points::appendAttribute(grid_.tree(), name, Array::attributeType());
        openvdb::points::populateAttribute(grid_.tree(), index_.tree(), name, computed<Value>(count_, function));
    }

private:
    openvdb::points::PointDataGrid& grid_;
    const openvdb::tools::PointIndexGrid& index_;
    std::size_t count_;
};

Vec3f vdb_vector(const Imath::V3f& v) {
    return {v.x, v.y, v.z};
}

}  // namespace

void write_vdb_points(FileWriter& file, const LitCloud& cloud, const OutputInfo& info,
                      const ProgressCallback& progress) {
    openvdb::initialize();
    report_progress(progress, "write", 0);
    const FilePoints points(cloud.points, info.up);
    const std::size_t count = cloud.points.size();
    const double voxel_size = voxel_size_for_points(cloud.points);

    // Built about the offset, so that positions within the voxels keep their digits.
    const auto local = openvdb::math::Transform::createLinearTransform(voxel_size);
    const auto positions = computed<openvdb::Vec3d>(count, [&](std::size_t i) {
        const Imath::V3f position = points.position(i);
        return openvdb::Vec3d(position.x, position.y, position.z);
    });
    const auto index = openvdb::tools::createPointIndexGrid<openvdb::tools::PointIndexGrid>(positions, *local);
    const auto grid = openvdb::points::createPointDataGrid<openvdb::points::NullCodec, openvdb::points::PointDataGrid>(
        *index, positions, *local);
    report_progress(progress, "write", 0.3);

    const Attributes attributes(*grid, *index, count);
    attributes.add<Vec3f>("N", [&](std::size_t i) { return vdb_vector(points.normal(i)); });
    attributes.add<Vec3f>("Cd", [&](std::size_t i) { return vdb_vector(display_color(cloud, i, 1)); });
    attributes.add<float>("pscale", [&](std::size_t i) { return radius_at(cloud.points, i); });
    if (!cloud.irradiance.empty())
        attributes.add<Vec3f>("irradiance", [&](std::size_t i) { return vdb_vector(cloud.irradiance[i]); });
    if (!cloud.points.albedo.empty())
        attributes.add<Vec3f>("albedo", [&](std::size_t i) { return vdb_vector(cloud.points.albedo[i]); });
    report_progress(progress, "write", 0.7);

    grid->setTransform(voxel_transform(voxel_size, points.offset()));
    describe_grid(*grid, "points", info, points.offset());
    write_vdb(file, {grid}, cloud, info, "points");
    report_progress(progress, "write", 1);
}

}  // namespace vmap
