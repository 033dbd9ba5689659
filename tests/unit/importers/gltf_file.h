// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// glTF files made by hand for tests: a JSON document that a test may bend as it likes, and a buffer.
#pragma once

#include <vmap/importers/gltf.h>

#include <Imath/ImathVec.h>
#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace vmap::test {

using nlohmann::json;

/// A folder of its own for each test, removed at the end.
class TestFolder {
public:
    TestFolder();
    ~TestFolder();
    TestFolder(const TestFolder&) = delete;
    TestFolder& operator=(const TestFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

void write_file(const std::filesystem::path& path, const std::string& content);
[[nodiscard]] std::string read_file_text(const std::filesystem::path& path);

class GltfFile {
public:
    /// A document without content.
    GltfFile();

    json document;
    std::string buffer;

    /// Adds bytes to the buffer; returns the number of the view.
    std::size_t add_view(std::span<const std::byte> bytes);
    /// Adds an accessor over packed values; component and type as glTF has them.
    std::size_t add_accessor(std::span<const std::byte> bytes, int component, const char* type, std::size_t count);
    std::size_t add_floats(const std::vector<float>& values, const char* type);
    std::size_t add_vectors(const std::vector<Imath::V3f>& values);
    std::size_t add_indices(const std::vector<std::uint16_t>& values);

    /// Adds to an array of the document; returns the number of the element.
    std::size_t add(const char* array, json element);
    /// Adds a node of the scene.
    std::size_t add_node(json node);
    /// A mesh of one primitive and a node that shows it; returns the number of the mesh.
    std::size_t add_mesh(json primitive, json node = json::object());
    /// The triangle (0 0 0) (1 0 0) (0 1 0) with a material that is white and not metallic.
    std::size_t add_triangle(json node = json::object());

    /// The file as .gltf with its buffer inside, or as .glb.
    [[nodiscard]] std::string text() const;
    [[nodiscard]] std::string binary() const;

    /// Writes it and reads it again.
    [[nodiscard]] Input import(const InputConfig& config = {}) const;

private:
    [[nodiscard]] std::string document_text(bool embedded) const;
};

template <class T>
[[nodiscard]] std::span<const std::byte> bytes_of(const std::vector<T>& values) {
    return std::as_bytes(std::span(values));
}

/// Imports a content under a name of its own.
[[nodiscard]] Input import_content(const std::string& content, const InputConfig& config = {});

/// What an import complains about; empty when it succeeds.
[[nodiscard]] std::string complaint_about(const std::string& content);

}  // namespace vmap::test
