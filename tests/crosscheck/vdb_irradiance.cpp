// SPDX-License-Identifier: GPL-3.0-or-later
#include <crosscheck/vdb_irradiance.h>

#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>

namespace vmap::crosscheck {

class VdbIrradiance::Grid {
public:
    explicit Grid(const std::filesystem::path& name) {
        openvdb::initialize();
        openvdb::io::File file(name.string());
        file.open();
        irradiance_ = openvdb::gridPtrCast<openvdb::Vec3SGrid>(file.readGrid("irradiance"));
    }
    [[nodiscard]] const openvdb::Vec3SGrid& irradiance() const { return *irradiance_; }

private:
    openvdb::Vec3SGrid::Ptr irradiance_;
};

VdbIrradiance::VdbIrradiance(const std::filesystem::path& file) : grid_(std::make_unique<Grid>(file)) {}
VdbIrradiance::~VdbIrradiance() = default;

Imath::C3f VdbIrradiance::at(const Imath::V3d& position) const {
    const openvdb::Vec3d place = grid_->irradiance().worldToIndex({position.x, -position.z, position.y});
    const openvdb::Vec3s value = openvdb::tools::BoxSampler::sample(grid_->irradiance().tree(), place);
    return {value.x(), value.y(), value.z()};
}

double VdbIrradiance::voxel_size() const {
    return grid_->irradiance().voxelSize().x();
}

}  // namespace vmap::crosscheck
