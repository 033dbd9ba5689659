// SPDX-License-Identifier: GPL-3.0-or-later
#include "gltf_file.h"

#include <vmap/error.h>

#include <unistd.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace vmap::test {
namespace {

namespace fs = std::filesystem;

std::string base64(const std::string& bytes) {
    constexpr const char* alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8U | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : alphabet[group >> (18 - 6 * k) & 63U];
    }
    return text;
}

void append_word(std::string& bytes, std::size_t value) {
    for (unsigned shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(value >> shift & 0xFFU);
}

}  // namespace

TestFolder::TestFolder() {
    std::string pattern = (fs::temp_directory_path() / "vmap-test-XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("cannot make a folder for the test");
    path_ = pattern;
}

TestFolder::~TestFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

void write_file(const fs::path& path, const std::string& content) {
    std::ofstream file(path, std::ios::binary);
    file << content;
    if (!file.flush()) throw std::runtime_error("cannot write " + path.string());
}

std::string read_file_text(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

GltfFile::GltfFile() {
    document = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", json::array({json::object()})}};
}

std::size_t GltfFile::add_view(std::span<const std::byte> bytes) {
    buffer.resize((buffer.size() + 3) / 4 * 4);
    const std::size_t offset = buffer.size();
    buffer.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return add("bufferViews", {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes.size()}});
}

std::size_t GltfFile::add_accessor(std::span<const std::byte> bytes, int component, const char* type,
                                   std::size_t count) {
    const std::size_t view = add_view(bytes);
    return add("accessors", {{"bufferView", view}, {"componentType", component}, {"type", type}, {"count", count}});
}

std::size_t GltfFile::add_floats(const std::vector<float>& values, const char* type) {
    const std::string name = type;
    const std::size_t components = name == "SCALAR" ? 1 : name == "MAT4" ? 16 : static_cast<std::size_t>(type[3] - '0');
    return add_accessor(bytes_of(values), 5126, type, values.size() / components);
}

std::size_t GltfFile::add_vectors(const std::vector<Imath::V3f>& values) {
    return add_accessor(bytes_of(values), 5126, "VEC3", values.size());
}

std::size_t GltfFile::add_indices(const std::vector<std::uint16_t>& values) {
    return add_accessor(bytes_of(values), 5123, "SCALAR", values.size());
}

std::size_t GltfFile::add(const char* array, json element) {
    document[array].push_back(std::move(element));
    return document[array].size() - 1;
}

std::size_t GltfFile::add_node(json node) {
    const std::size_t index = add("nodes", std::move(node));
    document["scenes"][0]["nodes"].push_back(index);
    return index;
}

std::size_t GltfFile::add_mesh(json primitive, json node) {
    const std::size_t mesh = add("meshes", {{"primitives", json::array({std::move(primitive)})}});
    node["mesh"] = mesh;
    add_node(std::move(node));
    return mesh;
}

std::size_t GltfFile::add_triangle(json node) {
    if (!document.contains("materials")) add("materials", {{"pbrMetallicRoughness", {{"metallicFactor", 0}}}});
    const std::size_t positions = add_vectors({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    return add_mesh({{"attributes", {{"POSITION", positions}}}, {"material", 0}}, std::move(node));
}

std::string GltfFile::document_text(bool embedded) const {
    json complete = document;
    if (!buffer.empty() && !complete.contains("buffers")) {
        complete["buffers"] = json::array({{{"byteLength", buffer.size()}}});
        if (embedded) complete["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64(buffer);
    }
    return complete.dump();
}

std::string GltfFile::text() const {
    return document_text(true);
}

std::string GltfFile::binary() const {
    std::string text = document_text(false);
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string padded = buffer;
    padded.resize((padded.size() + 3) / 4 * 4);
    std::string bytes = "glTF";
    append_word(bytes, 2);
    append_word(bytes, 12 + 8 + text.size() + 8 + padded.size());
    append_word(bytes, text.size());
    bytes += "JSON" + text;
    append_word(bytes, padded.size());
    bytes += std::string("BIN\0", 4) + padded;
    return bytes;
}

Input GltfFile::import(const InputConfig& config) const {
    return import_content(text(), config);
}

Input import_content(const std::string& content, const InputConfig& config) {
    const TestFolder folder;
    const fs::path path = folder.path() / "test.gltf";
    write_file(path, content);
    return import_gltf(path, config);
}

std::string complaint_about(const std::string& content) {
    try {
        static_cast<void>(import_content(content));
        return "";
    } catch (const Error& error) {
        return error.what();
    }
}

}  // namespace vmap::test
