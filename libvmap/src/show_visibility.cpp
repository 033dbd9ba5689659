// SPDX-License-Identifier: Apache-2.0
#include <vmap/show_visibility.h>

#include <tbb/parallel_for.h>

#include <map>

namespace vmap {

std::vector<float> visibility_from(const VmapQuery& query, std::size_t points, std::uint32_t from) {
    std::vector<float> seen(points);
    tbb::parallel_for(std::size_t{0}, points,
                      [&](std::size_t i) { seen[i] = query.sees(from, static_cast<std::uint32_t>(i)) ? 1.0F : 0.0F; });
    return seen;
}

SceneLights scene_lights(const PointCloud& cloud, std::span<const LightSource> sources) {
    SceneLights lights{{sources.begin(), sources.end()}, {}};
    if (!cloud.emits()) return lights;
    std::map<std::uint32_t, std::vector<std::uint32_t>> by_material;
    for (std::uint32_t i = 0; i < cloud.size(); ++i) {
        const Imath::C3f& emission = cloud.emission[i];
        if (emission.x > 0 || emission.y > 0 || emission.z > 0)
            by_material[cloud.materials.empty() ? 0 : cloud.materials[i]].push_back(i);
    }
    for (auto& group : by_material) lights.surfaces.push_back(std::move(group.second));
    return lights;
}

PairStatus light_status(const VmapQuery& query, std::uint32_t x, const SceneLights& lights, std::size_t light,
                        QueryCost* cost) {
    if (light >= lights.sources.size())
        return query.light_status(x, lights.surfaces[light - lights.sources.size()], cost);
    if (cost != nullptr) ++cost->primitive_tests;
    return query.light_status(x, lights.sources[light]);
}

std::vector<float> umbra_picture(const VmapQuery& query, std::size_t points, const SceneLights& lights) {
    std::vector<float> share(points, 1.0F);
    if (lights.size() == 0) return share;
    tbb::parallel_for(std::size_t{0}, points, [&](std::size_t i) {
        float sum = 0;
        for (std::size_t light = 0; light < lights.size(); ++light) {
            const PairStatus status = light_status(query, static_cast<std::uint32_t>(i), lights, light);
            sum += status == PairStatus::visible ? 1.0F : (status == PairStatus::partial ? 0.5F : 0.0F);
        }
        share[i] = sum / static_cast<float>(lights.size());
    });
    return share;
}

}  // namespace vmap
