// SPDX-License-Identifier: Apache-2.0
#include "direct_light.h"

#include "tile_lighter.h"

#include <tbb/parallel_for.h>

#include <atomic>
#include <mutex>

namespace vmap {

using Imath::C3f;

std::vector<C3f> direct_light(const Surface& surface, std::span<const Emitter> emitters,
                              std::span<const LightSource> sources, double tolerance, std::uint64_t seed,
                              const ProgressCallback& progress) {
    const Lights lights(emitters, sources, surface.cloud.origin);
    std::vector<C3f> irradiance(surface.cloud.size(), C3f(0, 0, 0));
    std::atomic<std::size_t> done{0};
    std::mutex reporting;
    tbb::parallel_for(std::size_t{0}, surface.tiles.size(), [&](std::size_t t) {
        TileLighter(surface, surface.tiles[t], lights, tolerance, seed, irradiance).run();
        const std::size_t count = ++done;
        if (count % 256 != 0) return;
        const std::lock_guard lock(reporting);
        report_progress(progress, "direct", static_cast<double>(count) / static_cast<double>(surface.tiles.size()));
    });
    return irradiance;
}

}  // namespace vmap
