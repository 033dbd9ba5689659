// SPDX-License-Identifier: GPL-3.0-or-later
// Surface to points and points to a PLY file, without fsync. Counters: points per second of wall time, and bytes per
// point that the process takes at its peak above what the scene takes.
#include <vmap/exporters/ply.h>
#include <vmap/importers/input.h>
#include <vmap/importers/sample_surface.h>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <string>

namespace vmap {
namespace {

using Imath::V2f;
using Imath::V3f;

/// Memory of the process in bytes, by its name in /proc/self/status.
double memory(const std::string& name) {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;) {
        double kilobytes = 0;
        if (word == name + ":" && status >> kilobytes) return kilobytes * 1024;
    }
    return 0;
}

void forget_peak() {
    std::ofstream("/proc/self/clear_refs") << 5;
}

/// A square of hills under a checkerboard whose squares are finer than any spacing used here.
Scene hills(int columns, bool is_textured) {
    Mesh mesh;
    mesh.texcoords.resize(1);
    for (int y = 0; y <= columns; ++y)
        for (int x = 0; x <= columns; ++x) {
            const V2f uv(static_cast<float>(x) / static_cast<float>(columns),
                         static_cast<float>(y) / static_cast<float>(columns));
            const V2f p = uv * 10.0F;
            const float height = std::sin(2 * p.x) * std::cos(1.7F * p.y) + 0.1F * std::sin(13 * p.x + 7 * p.y);
            mesh.positions.emplace_back(p.x, height, -p.y);
            mesh.texcoords[0].push_back(uv);
        }
    const auto at = [&](int x, int y) { return static_cast<std::uint32_t>(y * (columns + 1) + x); };
    for (int y = 0; y < columns; ++y)
        for (int x = 0; x < columns; ++x)
            for (const std::uint32_t i :
                 {at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y), at(x + 1, y + 1), at(x, y + 1)})
                mesh.indices.push_back(i);

    Scene scene;
    scene.source = "hills";
    scene.materials.resize(1);
    if (is_textured) {
        constexpr int side = 2048;
        Image image{.name = "checks", .width = side, .height = side, .rgba = {}};
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x)
                image.rgba.insert(image.rgba.end(), 4, static_cast<std::uint8_t>((x + y) % 2 == 0 ? 255 : 0));
        scene.images.push_back(std::move(image));
        scene.materials[0].base_color_texture = TextureView{};
    }
    scene.meshes.push_back(std::move(mesh));
    scene.instances = {{.name = "hills", .mesh = 0, .world_from_mesh = Imath::M44d()}};
    return scene;
}

void sample_and_write(benchmark::State& state, const std::function<Scene()>& make_scene, SamplePattern pattern) {
    const Scene scene = make_scene();
    SampleConfig config;
    config.pattern = pattern;
    config.points = static_cast<std::size_t>(state.range(0));
    const auto file = std::filesystem::temp_directory_path() / "vmap_bench_sampling.ply";
    double most = 0;
    for ([[maybe_unused]] const auto& step : state) {
        forget_peak();
        const double before = memory("VmRSS");
        LitCloud cloud;
        cloud.points = sample_surface(scene, config);
        FileWriter writer(file, Durability::fast);
        write_ply(writer, cloud, {});
        writer.commit();
        most = std::max(most, memory("VmHWM") - before);
    }
    std::filesystem::remove(file);
    const auto points = static_cast<double>(state.range(0));
    state.counters["points_per_second"] = benchmark::Counter(points, benchmark::Counter::kIsIterationInvariantRate);
    state.counters["peak_bytes_per_point"] = most / points;
}

void add(const std::string& name, const std::function<Scene()>& make_scene) {
    for (const auto& [pattern_name, pattern] :
         {std::pair("blue_noise", SamplePattern::blue_noise), std::pair("stratified", SamplePattern::stratified)})
        benchmark::RegisterBenchmark((name + "/" + pattern_name).c_str(), sample_and_write, make_scene, pattern)
            ->Arg(200'000)
            ->Arg(5'000'000)
            ->Unit(benchmark::kMillisecond)
            ->UseRealTime();
}

}  // namespace
}  // namespace vmap

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    vmap::add("cornell_box", [] { return vmap::read_input(VMAP_SCENES "/cornell_box.gltf").scene; });
    vmap::add("hills_80k_triangles", [] { return vmap::hills(200, false); });
    vmap::add("hills_80k_triangles_textured", [] { return vmap::hills(200, true); });
    vmap::add("hills_1M_triangles", [] { return vmap::hills(707, false); });
    const std::filesystem::path models = VMAP_SHARED "/models";
    for (const char* name : {"armadillo.off", "dragon.obj"}) {
        const std::filesystem::path file = models / name;
        if (std::filesystem::exists(file))
            vmap::add(file.stem(), [file] { return vmap::read_input(file).scene; });
        else
            std::cerr << "SKIPPED " << name << ": " << file << " is absent\n";
    }
    benchmark::RunSpecifiedBenchmarks();
}
