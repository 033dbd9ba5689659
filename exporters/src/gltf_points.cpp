// SPDX-License-Identifier: GPL-3.0-or-later
#include <vmap/exporters/base64.h>
#include "file_points.h"
#include "row_stream.h"

#include <vmap/error.h>
#include <vmap/exporters/gltf_points.h>
#include <vmap/printable.h>
#include <vmap/version.h>

#include <Imath/ImathBox.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace vmap {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t bytes_per_value = 3 * sizeof(float);

/// One attribute of the vertices.
struct Attribute {
    const char* name;
    std::function<Imath::V3f(std::size_t)> value;
};

Imath::C3f clamped(const Imath::C3f& color) {
    const auto clamp = [](float x) { return x > 0 ? std::min(x, 1.0F) : 0.0F; };  // NaN becomes 0
    return {clamp(color.x), clamp(color.y), clamp(color.z)};
}

std::vector<Attribute> attributes_of(const LitCloud& cloud, const FilePoints& points, const OutputInfo& info,
                                     const GltfPointsConfig& config) {
    std::vector<Attribute> attributes;
    attributes.push_back({"POSITION", [&](std::size_t i) { return points.position(i); }});
    attributes.push_back({"COLOR_0", [&cloud, exposure = info.exposure](std::size_t i) {
                              return clamped(display_color(cloud, i, exposure));
                          }});
    if (!cloud.irradiance.empty())
        attributes.push_back({"_IRRADIANCE", [&](std::size_t i) { return cloud.irradiance[i]; }});
    if (!cloud.points.albedo.empty())
        attributes.push_back({"_ALBEDO", [&](std::size_t i) { return cloud.points.albedo[i]; }});
    if (cloud.points.emits())
        attributes.push_back({"_EMISSION", [&](std::size_t i) { return cloud.points.emission[i]; }});
    if (!cloud.points.normals.empty()) {
        attributes.push_back({"_NORMAL", [&](std::size_t i) { return points.normal(i); }});
        if (config.normals) attributes.push_back({"NORMAL", [&](std::size_t i) { return points.normal(i); }});
    }
    return attributes;
}

double mean_radius(const PointCloud& cloud) {
    double sum = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) sum += static_cast<double>(radius_at(cloud, i));
    return cloud.empty() ? 0 : sum / static_cast<double>(cloud.size());
}

ordered_json asset_of(const OutputInfo& info) {
    return {{"version", "2.0"},
            {"generator", fmt::format("vmap {}", version)},
            {"extras",
             {{"up", name_of(info.up)},
              {"light_units", name_of(info.light_units)},
              {"light_factor_punctual", punctual_factor(info.light_units)},
              {"light_factor_directional", directional_factor(info.light_units)},
              {"exposure", info.exposure},
              {"source", header_text(info.source)}}}};
}

/// An array of one element; plain braces would be ambiguous.
ordered_json array(ordered_json element) {
    ordered_json result = ordered_json::array();
    result.push_back(std::move(element));
    return result;
}

ordered_json array_of(const Imath::V3d& v) {
    return ordered_json::array({v.x, v.y, v.z});
}

/// Bytes of all attributes, then of the areas.
std::size_t data_size_of(const LitCloud& cloud, const std::vector<Attribute>& attributes) {
    return cloud.points.size() * bytes_per_value * attributes.size() + cloud.points.areas.size() * sizeof(float);
}

/// Appends a buffer view and its accessor of floats; returns the accessor's index.
std::size_t add_accessor(ordered_json& document, std::size_t offset, std::size_t count, const char* type,
                         std::size_t components) {
    constexpr int array_buffer = 34962;
    constexpr int component_float = 5126;
    const std::size_t index = document["accessors"].size();
    document["bufferViews"].push_back({{"buffer", 0},
                                       {"byteOffset", offset},
                                       {"byteLength", count * components * sizeof(float)},
                                       {"target", array_buffer}});
    document["accessors"].push_back(
        {{"bufferView", index}, {"componentType", component_float}, {"count", count}, {"type", type}});
    return index;
}

ordered_json document_of(const LitCloud& cloud, const FilePoints& points, const OutputInfo& info,
                         const std::vector<Attribute>& attributes) {
    ordered_json document;
    document["asset"] = asset_of(info);
    document["scene"] = 0;
    document["scenes"] = array({{"name", "lit points"}});
    const std::size_t count = cloud.points.size();
    if (count == 0) return document;

    document["scenes"][0]["nodes"] = array(0);
    document["extensionsUsed"] = array("KHR_materials_unlit");
    ordered_json node = {{"name", "lit points"}, {"mesh", 0}};
    if (points.offset() != Imath::V3d(0, 0, 0)) node["translation"] = array_of(points.offset());
    document["nodes"] = array(node);
    document["materials"] = array({{"name", "lit points"},
                                   {"pbrMetallicRoughness", {{"metallicFactor", 0.0}, {"roughnessFactor", 1.0}}},
                                   {"extensions", {{"KHR_materials_unlit", ordered_json::object()}}}});
    document["buffers"] = array({{"byteLength", data_size_of(cloud, attributes)}});

    ordered_json primitive = {{"mode", 0}, {"material", 0}, {"attributes", ordered_json::object()}};
    document["bufferViews"] = ordered_json::array();
    document["accessors"] = ordered_json::array();
    std::size_t offset = 0;
    for (const Attribute& attribute : attributes) {
        primitive["attributes"][attribute.name] = add_accessor(document, offset, count, "VEC3", 3);
        offset += count * bytes_per_value;
    }
    Imath::Box3f box;
    for (std::size_t i = 0; i < count; ++i) box.extendBy(points.position(i));
    document["accessors"][0]["min"] = array_of(Imath::V3d(box.min));
    document["accessors"][0]["max"] = array_of(Imath::V3d(box.max));
    ordered_json extras = {{"radius", mean_radius(cloud.points)}};
    if (!cloud.points.areas.empty()) extras["areas"] = add_accessor(document, offset, count, "SCALAR", 1);
    document["meshes"] = array({{"name", "lit points"}, {"primitives", array(primitive)}, {"extras", extras}});
    return document;
}

using Sink = std::function<void(const char* data, std::size_t size)>;

/// Attribute after attribute and then the areas, as the buffer views name them.
void stream_data(const LitCloud& cloud, const std::vector<Attribute>& attributes, const Sink& sink,
                 const ProgressCallback& progress) {
    const auto total = static_cast<double>(data_size_of(cloud, attributes));
    std::size_t written = 0;
    const auto count_and_sink = [&](const char* data, std::size_t size, std::size_t) {
        sink(data, size);
        written += size;
        report_progress(progress, "write", static_cast<double>(written) / total);
    };
    const auto put_areas = [&](RowBuffer& row, std::size_t i) { row.put(cloud.points.areas[i]); };
    for (const Attribute& attribute : attributes)
        stream_rows(
            cloud.points.size(), bytes_per_value, [&](RowBuffer& row, std::size_t i) { row.put(attribute.value(i)); },
            count_and_sink);
    stream_rows(cloud.points.areas.size(), sizeof(float), put_areas, count_and_sink);
}

using StreamData = std::function<void(const Sink&)>;

void write_binary(FileWriter& file, const ordered_json& document, std::size_t data_size, const StreamData& stream) {
    std::string json = document.dump();
    json.resize((json.size() + 3) / 4 * 4, ' ');

    const auto put = [&](std::size_t value) {
        const auto word = static_cast<std::uint32_t>(value);
        file.write(&word, sizeof word);
    };
    const std::size_t chunk_header = 8;
    const std::size_t total = 12 + chunk_header + json.size() + (data_size > 0 ? chunk_header + data_size : 0);
    if (total > std::numeric_limits<std::uint32_t>::max())
        throw UnsupportedInput(fmt::format("{}: {} bytes of points, but a .glb file holds at most 4 GiB",
                                           printable(file.path()), data_size));
    file.write("glTF", 4);
    put(2);
    put(total);
    put(json.size());
    file.write("JSON", 4);
    file.write(json.data(), json.size());
    if (data_size == 0) return;
    put(data_size);
    file.write("BIN\0", 4);
    stream([&](const char* data, std::size_t size) { file.write(data, size); });
}

void write_embedded(FileWriter& file, ordered_json document, std::size_t data_size, const StreamData& stream) {
    if (data_size == 0) {
        file.stream() << document.dump(2) << '\n';
        return;
    }
    // The marker stands where the data belongs. Foreign names come before it, so the last one is ours.
    constexpr std::string_view marker = ";base64,*";
    document["buffers"][0]["uri"] = std::string("data:application/octet-stream") + std::string(marker);
    const std::string json = document.dump(2);
    const std::size_t place = json.rfind(marker) + marker.size() - 1;
    file.write(json.data(), place);
    const auto put = [&](std::string_view bytes) {
        const std::string text = base64(bytes);
        file.write(text.data(), text.size());
    };
    std::string waiting;  // texts join where their bytes are a multiple of three
    stream([&](const char* data, std::size_t size) {
        waiting.append(data, size);
        const std::size_t whole = waiting.size() / 3 * 3;
        put(std::string_view(waiting).substr(0, whole));
        waiting.erase(0, whole);
    });
    put(waiting);
    file.stream() << std::string_view(json).substr(place + 1) << '\n';
}

}  // namespace

void write_gltf_points(FileWriter& file, const LitCloud& cloud, const OutputInfo& info, const GltfPointsConfig& config,
                       const ProgressCallback& progress) {
    const FilePoints points(cloud.points, info.up);
    const std::vector<Attribute> attributes = attributes_of(cloud, points, info, config);
    const std::size_t data_size = data_size_of(cloud, attributes);
    const auto stream = [&](const Sink& sink) { stream_data(cloud, attributes, sink, progress); };

    const ordered_json document = document_of(cloud, points, info, attributes);
    if (config.container == GltfContainer::binary)
        write_binary(file, document, data_size, stream);
    else
        write_embedded(file, document, data_size, stream);
}

}  // namespace vmap
