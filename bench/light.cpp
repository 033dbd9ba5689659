// SPDX-License-Identifier: GPL-3.0-or-later
// Light of the Cornell box at 138 240 blue-noise points, from points in memory to irradiance in memory: by tolerance,
// and by the number of point lights under its ceiling.
#include <vmap/importers/input.h>
#include <vmap/importers/sample_surface.h>
#include <vmap/light.h>

#include <benchmark/benchmark.h>

#include <Imath/ImathBox.h>

#include <cmath>
#include <random>

namespace vmap {
namespace {

struct Box {
    PointCloud cloud;
    Imath::Box3d bounds;

    Box() {
        SampleConfig config;
        config.points = 138240;
        cloud = sample_surface(read_input(VMAP_SCENES "/cornell_box.gltf").scene, config);
        for (const Imath::V3f& p : cloud.positions) bounds.extendBy(cloud.origin + Imath::V3d(p));
    }
};

const Box& box() {
    static const Box made;
    return made;
}

void report(benchmark::State& state, const LightReport& light) {
    state.counters["tree"] = light.tree_seconds;
    state.counters["direct"] = light.direct_seconds;
    state.counters["indirect"] = light.indirect_seconds;
}

/// The argument is 10 000 times the tolerance.
void light_by_tolerance(benchmark::State& state) {
    const LightConfig config{.tolerance = 1e-4 * static_cast<double>(state.range(0))};
    box();
    LightReport last;
    for (auto _ : state) last = compute_light(box().cloud, {}, config).report;
    report(state, last);
}
BENCHMARK(light_by_tolerance)
    ->Arg(400)
    ->Arg(200)
    ->Arg(100)
    ->Arg(50)
    ->Arg(25)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

void point_lights(benchmark::State& state) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> share(0.05, 0.95);
    std::vector<LightSource> lights(static_cast<std::size_t>(state.range(0)));
    const Imath::V3d size = box().bounds.size();
    for (LightSource& light : lights) {
        light.position = box().bounds.min + size * Imath::V3d(share(random), 0.7 + 0.28 * share(random), share(random));
        light.intensity = Imath::C3f(1);
    }
    LightReport last;
    for (auto _ : state) last = compute_light(box().cloud, lights).report;
    report(state, last);
}
BENCHMARK(point_lights)->RangeMultiplier(10)->Range(1, 10000)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace vmap

BENCHMARK_MAIN();
