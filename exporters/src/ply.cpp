// SPDX-License-Identifier: GPL-3.0-or-later
#include <vmap/exporters/ply.h>
#include <vmap/srgb.h>
#include <vmap/version.h>

#include <fmt/format.h>
#include <tbb/parallel_pipeline.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

namespace vmap {
namespace {

static_assert(std::endian::native == std::endian::little, "rows are copied as they lie in memory");

constexpr std::size_t points_per_chunk = 16384;
constexpr std::size_t chunks_in_flight = 8;

std::string header_of(const LitCloud& cloud, const OutputInfo& info, const Imath::V3d& offset) {
    std::string header = "ply\nformat binary_little_endian 1.0\n";
    const auto add = [&](const std::string& line) { header += line + '\n'; };
    const auto add_properties = [&](const char* type, std::initializer_list<const char*> names) {
        for (const char* name : names) add(fmt::format("property {} {}", type, name));
    };

    const Imath::V3d file_offset = file_from_world(info.up, offset);
    add(fmt::format("comment up {}", name_of(info.up)));
    add(fmt::format("comment light_units {} punctual {} directional {}", name_of(info.light_units),
                    punctual_factor(info.light_units), directional_factor(info.light_units)));
    add(fmt::format("comment offset {} {} {}", file_offset.x, file_offset.y, file_offset.z));
    add(fmt::format("comment exposure {}", info.exposure));
    add(fmt::format("comment vmap {}", version));
    add(fmt::format("comment source {}", header_text(info.source)));
    add(fmt::format("element vertex {}", cloud.points.size()));
    add_properties("float", {"x", "y", "z", "nx", "ny", "nz"});
    add_properties("uchar", {"red", "green", "blue"});
    if (!cloud.irradiance.empty()) add_properties("float", {"irradiance_r", "irradiance_g", "irradiance_b"});
    add_properties("float", {"albedo_r", "albedo_g", "albedo_b", "radius", "area"});
    add_properties("uint", {"face_id", "material_id"});
    if (cloud.points.emits()) add_properties("float", {"emission_r", "emission_g", "emission_b"});
    add("end_header");
    return header;
}

/// Lays out rows one after the other.
class RowBuffer {
public:
    explicit RowBuffer(std::size_t size) : bytes_(size) {}

    template <class T>
        requires std::is_arithmetic_v<T>
    void put(T value) {
        std::memcpy(bytes_.data() + used_, &value, sizeof value);
        used_ += sizeof value;
    }
    void put(const Imath::V3f& value) {
        put(value.x);
        put(value.y);
        put(value.z);
    }

    void clear() { used_ = 0; }
    [[nodiscard]] const char* data() const { return bytes_.data(); }
    [[nodiscard]] std::size_t size() const { return used_; }

private:
    std::vector<char> bytes_;
    std::size_t used_ = 0;
};

std::size_t row_size(const LitCloud& cloud) {
    constexpr std::size_t always = 6 * 4 + 3 + 3 * 4 + 2 * 4 + 2 * 4;
    return always + (cloud.irradiance.empty() ? 0 : 12) + (cloud.points.emits() ? 12 : 0);
}

class RowFormat {
public:
    RowFormat(const LitCloud& cloud, const OutputInfo& info, const Imath::V3d& offset)
        : cloud_(cloud),
          up_(info.up),
          exposure_(static_cast<float>(info.exposure)),
          shift_(cloud.points.origin - offset),
          shifted_(shift_ != Imath::V3d(0, 0, 0)) {}

    void put(RowBuffer& row, std::size_t i) const {
        const PointCloud& points = cloud_.points;
        row.put(file_from_world(up_, position(i)));
        row.put(points.normals.empty() ? Imath::V3f(0, 0, 0) : file_from_world(up_, points.normals[i]));
        put_display_color(row, i);
        if (!cloud_.irradiance.empty()) row.put(cloud_.irradiance[i]);
        row.put(points.albedo.empty() ? Imath::C3f(0, 0, 0) : points.albedo[i]);
        row.put(radius_at(points, i));
        row.put(points.areas.empty() ? 0.0F : points.areas[i]);
        row.put(points.faces.empty() ? std::uint32_t{0} : points.faces[i]);
        row.put(points.materials.empty() ? std::uint32_t{0} : points.materials[i]);
        if (points.emits()) row.put(points.emission[i]);
    }

private:
    [[nodiscard]] Imath::V3f position(std::size_t i) const {
        const Imath::V3f& position = cloud_.points.positions[i];
        return shifted_ ? Imath::V3f(Imath::V3d(position) + shift_) : position;
    }

    void put_display_color(RowBuffer& row, std::size_t i) const {
        Imath::C3f shown(0, 0, 0);
        if (!cloud_.irradiance.empty())
            shown = radiance_at(cloud_, i) * exposure_;
        else if (!cloud_.points.albedo.empty())
            shown = cloud_.points.albedo[i];
        for (int channel = 0; channel < 3; ++channel) row.put(srgb8_from_linear(shown[channel]));
    }

    const LitCloud& cloud_;
    UpAxis up_;
    float exposure_;
    Imath::V3d shift_;  ///< from the cloud's origin to the file's
    bool shifted_;
};

struct Chunk {
    std::size_t begin = 0;
    std::size_t end = 0;
    RowBuffer* rows = nullptr;
};

}  // namespace

void write_ply(FileWriter& file, const LitCloud& cloud, const OutputInfo& info, const ProgressCallback& progress) {
    const Imath::V3d offset = output_offset(cloud.points);
    file.stream() << header_of(cloud, info, offset);

    // Chunks go round a ring of buffers: at most chunks_in_flight of them are alive, and they leave in order.
    const std::size_t count = cloud.points.size();
    const RowFormat format(cloud, info, offset);
    std::vector<RowBuffer> ring(chunks_in_flight, RowBuffer(points_per_chunk * row_size(cloud)));
    std::size_t next = 0;
    const auto take = [&](tbb::flow_control& flow) {
        if (next >= count) flow.stop();
        const Chunk chunk{next, std::min(next + points_per_chunk, count), &ring[next / points_per_chunk % ring.size()]};
        next = chunk.end;
        return chunk;
    };
    const auto lay_out = [&](const Chunk& chunk) {
        chunk.rows->clear();
        for (std::size_t i = chunk.begin; i < chunk.end; ++i) format.put(*chunk.rows, i);
        return chunk;
    };
    const auto write = [&](const Chunk& chunk) {
        file.write(chunk.rows->data(), chunk.rows->size());
        report_progress(progress, "write", static_cast<double>(chunk.end) / static_cast<double>(count));
    };
    using tbb::filter_mode;
    tbb::parallel_pipeline(chunks_in_flight, tbb::make_filter<void, Chunk>(filter_mode::serial_in_order, take) &
                                                 tbb::make_filter<Chunk, Chunk>(filter_mode::parallel, lay_out) &
                                                 tbb::make_filter<Chunk, void>(filter_mode::serial_in_order, write));
}

}  // namespace vmap
