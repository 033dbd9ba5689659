// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdb_archive.h"

#include "seekable_output.h"

#include <vmap/version.h>

#include <fmt/format.h>
#include <openvdb/io/Archive.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

namespace vmap {
namespace {

/// Opens the protected function that writes to any stream; errors of the stream come out as exceptions.
class StreamArchive : public openvdb::io::Archive {
public:
    void write_to(std::ostream& stream, const openvdb::GridCPtrVec& grids, const openvdb::MetaMap& metadata) const {
        Archive::write(stream, grids, /*seekable=*/true, metadata);
    }
    [[nodiscard]] Ptr copy() const override { return Ptr(new StreamArchive(*this)); }
};

// The header: magic number, three versions, one flag, then the UUID as text.
static_assert(openvdb::OPENVDB_FILE_VERSION == 224, "check where the UUID lies");
constexpr std::streamoff uuid_position = 8 + 3 * 4 + 1;

/// FNV-1a over 64-bit words, twice with different starts.
class ContentHash {
public:
    void add(std::string_view bytes) {
        add_word(bytes.size());
        for (std::size_t i = 0; i < bytes.size(); i += 8) {
            std::uint64_t word = 0;
            std::memcpy(&word, bytes.data() + i, std::min<std::size_t>(8, bytes.size() - i));
            add_word(word);
        }
    }
    template <class T>
    void add_array(const std::vector<T>& values) {
        add(std::string_view(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)));
    }

    /// As text, marked as a random UUID (RFC 4122, version 4).
    [[nodiscard]] std::string uuid() const {
        return fmt::format("{:08x}-{:04x}-4{:03x}-{:04x}-{:012x}", state_[0] >> 32, state_[0] >> 16 & 0xFFFF,
                           state_[0] & 0xFFF, (state_[1] >> 48 & 0x3FFF) | 0x8000, state_[1] & 0xFFFFFFFFFFFF);
    }

private:
    void add_word(std::uint64_t word) {
        for (std::uint64_t& state : state_) {
            state = (state ^ word) * 0x100000001B3;
            state ^= state >> 29;
        }
    }

    std::array<std::uint64_t, 2> state_{0xCBF29CE484222325, 0x84222325CBF29CE4};
};

std::string uuid_of(const LitCloud& cloud, const OutputInfo& info, const std::string& kind) {
    ContentHash hash;
    hash.add_array(cloud.points.positions);
    hash.add_array(cloud.points.normals);
    hash.add_array(cloud.points.areas);
    hash.add_array(cloud.points.albedo);
    hash.add_array(cloud.points.emission);
    hash.add_array(cloud.irradiance);
    const Imath::V3d& origin = cloud.points.origin;
    hash.add(fmt::format("{} {} {} {} {} {} {} {} {}", origin.x, origin.y, origin.z, name_of(info.up),
                         name_of(info.light_units), info.exposure, info.source, version, kind));
    return hash.uuid();
}

}  // namespace

openvdb::math::Transform::Ptr voxel_transform(double voxel_size, const Imath::V3d& file_offset) {
    auto transform = openvdb::math::Transform::createLinearTransform(voxel_size);
    transform->postTranslate({file_offset.x, file_offset.y, file_offset.z});
    return transform;
}

void describe_grid(openvdb::GridBase& grid, const std::string& name, const OutputInfo& info,
                   const Imath::V3d& file_offset) {
    using openvdb::DoubleMetadata;
    using openvdb::StringMetadata;
    grid.setName(name);
    grid.setCreator(fmt::format("vmap {}", version));
    grid.insertMeta("up", StringMetadata(std::string(name_of(info.up))));
    grid.insertMeta("light_units", StringMetadata(std::string(name_of(info.light_units))));
    grid.insertMeta("light_factor_punctual", DoubleMetadata(punctual_factor(info.light_units)));
    grid.insertMeta("light_factor_directional", DoubleMetadata(directional_factor(info.light_units)));
    grid.insertMeta("exposure", DoubleMetadata(info.exposure));
    grid.insertMeta("offset", openvdb::Vec3DMetadata({file_offset.x, file_offset.y, file_offset.z}));
    grid.insertMeta("source", StringMetadata(header_text(info.source)));
}

void write_vdb(FileWriter& file, const openvdb::GridCPtrVec& grids, const LitCloud& cloud, const OutputInfo& info,
               const std::string& kind) {
    const std::string uuid = uuid_of(cloud, info, kind);
    write_seekable(file, [&](std::ostream& stream) {
        StreamArchive().write_to(stream, grids, {});
        stream.seekp(uuid_position);
        stream << uuid;
        stream.seekp(0, std::ios_base::end);
    });
}

}  // namespace vmap
