// SPDX-License-Identifier: GPL-3.0-or-later
#include <reference/lit_ply.h>
#include <vmap/error.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <sstream>

namespace vmap::reference {
namespace {

using Imath::C3f;
using Imath::V3d;

struct Property {
    std::string type;
    std::size_t offset = 0;
};

struct Header {
    std::size_t count = 0;
    std::size_t row_size = 0;
    std::map<std::string, Property> properties;
    std::map<std::string, std::string> comments;
};

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& what) {
    throw FileError(file.string() + ": " + what);
}

std::size_t size_of(const std::string& type) {
    if (type == "float" || type == "uint" || type == "int") return 4;
    if (type == "uchar" || type == "char") return 1;
    if (type == "ushort" || type == "short") return 2;
    if (type == "double") return 8;
    return 0;
}

Header read_header(std::istream& stream, const std::filesystem::path& file) {
    Header header;
    std::string line;
    if (!std::getline(stream, line) || line != "ply") fail(file, "no PLY file, expected it to start with 'ply'");
    while (std::getline(stream, line) && line != "end_header") {
        std::istringstream words(line);
        std::string word;
        std::string type;
        std::string name;
        words >> word >> type;
        std::getline(words >> std::ws, name);
        if (word == "format" && type != "binary_little_endian")
            fail(file, "format " + type + ", expected binary_little_endian");
        if (word == "comment") header.comments[type] = name;
        if (word == "element" && type != "vertex") fail(file, "element " + type + ", expected only vertex");
        if (word == "element") header.count = std::stoull(name);
        if (word != "property") continue;
        if (size_of(type) == 0) fail(file, "property of type " + type + ", expected a scalar");
        header.properties[name] = {type, header.row_size};
        header.row_size += size_of(type);
    }
    if (line != "end_header") fail(file, "header without an end");
    return header;
}

/// Reads one row's values by the names of the properties.
class Row {
public:
    Row(const Header& header, const char* bytes, const std::filesystem::path& file)
        : header_(header), bytes_(bytes), file_(file) {}

    template <class T>
    [[nodiscard]] T value(const std::string& name, const char* type) const {
        const auto found = header_.properties.find(name);
        if (found == header_.properties.end() || found->second.type != type)
            fail(file_, "no property '" + name + "', expected one of type " + type);
        T result;
        std::memcpy(&result, bytes_ + found->second.offset, sizeof result);
        return result;
    }
    [[nodiscard]] float number(const std::string& name) const { return value<float>(name, "float"); }
    [[nodiscard]] V3d vector(const std::array<const char*, 3>& names) const {
        return {number(names[0]), number(names[1]), number(names[2])};
    }
    [[nodiscard]] C3f color(const std::string& stem) const {
        return {number(stem + "_r"), number(stem + "_g"), number(stem + "_b")};
    }

private:
    const Header& header_;
    const char* bytes_;
    const std::filesystem::path& file_;
};

}  // namespace

LitPly read_lit_ply(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) fail(file, "cannot be opened");
    const Header header = read_header(stream, file);
    if (header.row_size == 0) fail(file, "no properties");

    const bool z_up = header.comments.contains("up") && header.comments.at("up") == "z";
    const auto to_world = [&](const V3d& v) { return z_up ? V3d(v.x, v.z, -v.y) : v; };
    V3d offset(0);
    if (header.comments.contains("offset"))
        std::istringstream(header.comments.at("offset")) >> offset.x >> offset.y >> offset.z;

    LitPly points;
    points.comments = header.comments;
    const bool emits = header.properties.contains("emission_r");
    std::vector<char> bytes(header.row_size);
    for (std::size_t i = 0; i < header.count; ++i) {
        if (!stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size())))
            fail(file, "ends after " + std::to_string(i) + " of " + std::to_string(header.count) + " points");
        const Row row(header, bytes.data(), file);
        points.positions.push_back(to_world(row.vector({"x", "y", "z"}) + offset));
        points.normals.push_back(to_world(row.vector({"nx", "ny", "nz"})));
        points.irradiance.push_back(row.color("irradiance"));
        points.albedo.push_back(row.color("albedo"));
        if (emits) points.emission.push_back(row.color("emission"));
        points.areas.push_back(row.number("area"));
        points.faces.push_back(row.value<std::uint32_t>("face_id", "uint"));
    }
    return points;
}

}  // namespace vmap::reference
