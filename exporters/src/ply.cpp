// SPDX-License-Identifier: GPL-3.0-or-later
#include "file_points.h"
#include "row_stream.h"

#include <vmap/exporters/ply.h>
#include <vmap/srgb.h>
#include <vmap/version.h>

#include <fmt/format.h>

#include <cstdint>
#include <string>

namespace vmap {
namespace {

std::string header_of(const LitCloud& cloud, const OutputInfo& info, const Imath::V3d& file_offset) {
    std::string header = "ply\nformat binary_little_endian 1.0\n";
    const auto add = [&](const std::string& line) { header += line + '\n'; };
    const auto add_properties = [&](const char* type, std::initializer_list<const char*> names) {
        for (const char* name : names) add(fmt::format("property {} {}", type, name));
    };

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

std::size_t row_size(const LitCloud& cloud) {
    constexpr std::size_t always = 6 * 4 + 3 + 3 * 4 + 2 * 4 + 2 * 4;
    return always + (cloud.irradiance.empty() ? 0 : 12) + (cloud.points.emits() ? 12 : 0);
}

class RowFormat {
public:
    RowFormat(const LitCloud& cloud, const OutputInfo& info, const FilePoints& points)
        : cloud_(cloud), points_(points), exposure_(info.exposure) {}

    void put(RowBuffer& row, std::size_t i) const {
        const PointCloud& cloud = cloud_.points;
        row.put(points_.position(i));
        row.put(points_.normal(i));
        const Imath::C3f shown = display_color(cloud_, i, exposure_);
        for (int channel = 0; channel < 3; ++channel) row.put(srgb8_from_linear(shown[channel]));
        if (!cloud_.irradiance.empty()) row.put(cloud_.irradiance[i]);
        row.put(cloud.albedo.empty() ? Imath::C3f(0, 0, 0) : cloud.albedo[i]);
        row.put(radius_at(cloud, i));
        row.put(cloud.areas.empty() ? 0.0F : cloud.areas[i]);
        row.put(cloud.faces.empty() ? std::uint32_t{0} : cloud.faces[i]);
        row.put(cloud.materials.empty() ? std::uint32_t{0} : cloud.materials[i]);
        if (cloud.emits()) row.put(cloud.emission[i]);
    }

private:
    const LitCloud& cloud_;
    const FilePoints& points_;
    double exposure_;
};

}  // namespace

void write_ply(FileWriter& file, const LitCloud& cloud, const OutputInfo& info, const ProgressCallback& progress) {
    const FilePoints points(cloud.points, info.up);
    file.stream() << header_of(cloud, info, points.offset());

    const std::size_t count = cloud.points.size();
    const RowFormat format(cloud, info, points);
    stream_rows(
        count, row_size(cloud), [&](RowBuffer& row, std::size_t i) { format.put(row, i); },
        [&](const char* data, std::size_t size, std::size_t done) {
            file.write(data, size);
            report_progress(progress, "write", static_cast<double>(done) / static_cast<double>(count));
        });
}

}  // namespace vmap
