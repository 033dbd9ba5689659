// SPDX-License-Identifier: GPL-3.0-or-later
// Import of a large textured file: a million triangles, a 4096 x 4096 PNG, a 4096 x 4096 and a 2048 x 2048 JPEG, 28 MB
// of geometry. The peer is tinygltf, which parses and decodes with stb but neither checks nor builds a scene.
#include <vmap/importers/gltf.h>

#include <benchmark/benchmark.h>
#include <png.h>
#include <turbojpeg.h>
#include <nlohmann/json.hpp>

// Under a name of its own: Debian's libdraco exports a tinygltf of another version.
#define tinygltf peer_tinygltf
#define TINYGLTF_IMPLEMENTATION
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE
#include <stb/stb_image.h>
#include <tiny_gltf.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr int side = 708;  // vertices; 2 (side - 1)^2 = 999 698 triangles

/// A picture with large shapes and a little noise, so that it compresses like a photograph.
std::vector<std::uint8_t> picture(int size) {
    std::vector<std::uint8_t> rgb;
    rgb.reserve(3 * static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
    std::uint32_t random = 1;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            for (int channel = 0; channel < 3; ++channel) {
                random = random * 1664525U + 1013904223U;
                const double wave = std::sin(0.01 * x * (channel + 1)) * std::cos(0.013 * y);
                rgb.push_back(static_cast<std::uint8_t>(120 + 100 * wave + (random >> 29U)));
            }
    return rgb;
}

std::string png_of(int size) {
    std::vector<std::uint8_t> rgb = picture(size);
    std::string file;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(
        png, &file,
        [](png_structp writer, png_bytep bytes, std::size_t count) {
            static_cast<std::string*>(png_get_io_ptr(writer))->append(reinterpret_cast<const char*>(bytes), count);
        },
        nullptr);
    const auto width = static_cast<png_uint_32>(size);
    png_set_IHDR(png, info, width, width, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_set_compression_level(png, 3);
    png_write_info(png, info);
    for (int y = 0; y < size; ++y) png_write_row(png, rgb.data() + 3 * static_cast<std::size_t>(y) * width);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return file;
}

std::string jpeg_of(int size) {
    const std::vector<std::uint8_t> rgb = picture(size);
    tjhandle compressor = tjInitCompress();
    unsigned char* bytes = nullptr;
    unsigned long count = 0;
    tjCompress2(compressor, rgb.data(), size, 0, size, TJPF_RGB, &bytes, &count, TJSAMP_420, 90, 0);
    std::string file(reinterpret_cast<const char*>(bytes), count);
    tjFree(bytes);
    tjDestroy(compressor);
    return file;
}

/// Packs a GLB together.
class Builder {
public:
    template <class T>
    std::size_t add_view(const T& values) {
        data_.resize((data_.size() + 3) / 4 * 4);
        const std::size_t size = values.size() * sizeof(values[0]);
        document["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", data_.size()}, {"byteLength", size}});
        data_.append(reinterpret_cast<const char*>(values.data()), size);
        return document["bufferViews"].size() - 1;
    }

    void write(const fs::path& path) {
        data_.resize((data_.size() + 3) / 4 * 4);
        document["buffers"] = json::array({{{"byteLength", data_.size()}}});
        std::string text = document.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        std::ofstream file(path, std::ios::binary);
        const auto word = [&](std::size_t value) {
            const auto little = static_cast<std::uint32_t>(value);
            file.write(reinterpret_cast<const char*>(&little), 4);
        };
        file << "glTF";
        word(2);
        word(12 + 8 + text.size() + 8 + data_.size());
        word(text.size());
        file << "JSON" << text;
        word(data_.size());
        file.write("BIN\0", 4);
        file << data_;
    }

    json document = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}};

private:
    std::string data_;
};

void add_grid(Builder& file) {
    std::vector<float> positions;
    std::vector<float> normals;
    std::vector<float> texcoords;
    std::vector<std::uint32_t> indices;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const float u = static_cast<float>(x) / (side - 1);
            const float v = static_cast<float>(y) / (side - 1);
            positions.insert(positions.end(), {u, std::sin(9 * u) * std::sin(7 * v), v});
            normals.insert(normals.end(), {0, 1, 0});
            texcoords.insert(texcoords.end(), {u, v});
        }
    for (std::uint32_t y = 0; y + 1 < side; ++y)
        for (std::uint32_t x = 0; x + 1 < side; ++x) {
            const std::uint32_t a = y * side + x;
            for (const std::uint32_t i : {a, a + side, a + 1, a + 1, a + side, a + side + 1}) indices.push_back(i);
        }
    const auto accessor = [&](std::size_t view, int component, const char* type, std::size_t count) {
        return json{{"bufferView", view}, {"componentType", component}, {"type", type}, {"count", count}};
    };
    constexpr std::size_t vertices = static_cast<std::size_t>(side) * side;
    file.document["accessors"] = {accessor(file.add_view(positions), 5126, "VEC3", vertices),
                                  accessor(file.add_view(normals), 5126, "VEC3", vertices),
                                  accessor(file.add_view(texcoords), 5126, "VEC2", vertices),
                                  accessor(file.add_view(indices), 5125, "SCALAR", indices.size())};
    file.document["accessors"][0]["min"] = {0, -1, 0};
    file.document["accessors"][0]["max"] = {1, 1, 1};
    const json primitive = {
        {"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"TEXCOORD_0", 2}}}, {"indices", 3}, {"material", 0}};
    file.document["meshes"] = {{{"primitives", {primitive}}}};
    file.document["nodes"] = {{{"mesh", 0}}};
}

void add_material(Builder& file) {
    const auto add_image = [&](const std::string& bytes, const char* type) {
        file.document["images"].push_back({{"bufferView", file.add_view(bytes)}, {"mimeType", type}});
        file.document["textures"].push_back({{"source", file.document["images"].size() - 1}});
    };
    add_image(png_of(4096), "image/png");
    add_image(jpeg_of(4096), "image/jpeg");
    add_image(jpeg_of(2048), "image/jpeg");
    const auto texture = [](int index) { return json{{"index", index}}; };
    file.document["materials"] = {
        {{"pbrMetallicRoughness", {{"baseColorTexture", texture(0)}, {"metallicRoughnessTexture", texture(1)}}},
         {"emissiveTexture", texture(2)},
         {"emissiveFactor", {1, 1, 1}}}};
}

const fs::path& large_file() {
    static const fs::path path = [] {
        Builder file;
        add_grid(file);
        add_material(file);
        const fs::path made = fs::temp_directory_path() / "vmap-bench-large.glb";
        file.write(made);
        return made;
    }();
    return path;
}

/// Growth of the largest memory in use over what was in use before.
class PeakMemory {
public:
    PeakMemory() : before_(status("VmRSS")) { std::ofstream("/proc/self/clear_refs") << 5; }
    [[nodiscard]] double megabytes() const { return status("VmHWM") - before_; }

private:
    static double status(const std::string& key) {
        std::ifstream file("/proc/self/status");
        for (std::string line; std::getline(file, line);)
            if (line.starts_with(key + ":")) return std::stod(line.substr(key.size() + 1)) / 1024;
        return 0;
    }
    double before_;
};

void import_large(benchmark::State& state) {
    const fs::path& path = large_file();
    double peak = 0;
    while (state.KeepRunning()) {
        const PeakMemory memory;
        const vmap::Input input = vmap::import_gltf(path);
        if (input.scene.images.size() != 3) state.SkipWithError("the file was not read whole");
        peak = memory.megabytes();
    }
    state.counters["peak_MB"] = peak;
    state.counters["file_MB"] = static_cast<double>(fs::file_size(path)) / 1e6;
}
BENCHMARK(import_large)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();

void import_large_by_tinygltf(benchmark::State& state) {
    const fs::path& path = large_file();
    double peak = 0;
    while (state.KeepRunning()) {
        const PeakMemory memory;
        tinygltf::TinyGLTF reader;
        tinygltf::Model model;
        std::string error;
        std::string warning;
        if (!reader.LoadBinaryFromFile(&model, &error, &warning, path.string())) state.SkipWithError(error.c_str());
        peak = memory.megabytes();
    }
    state.counters["peak_MB"] = peak;
}
BENCHMARK(import_large_by_tinygltf)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();

}  // namespace

BENCHMARK_MAIN();
