// SPDX-License-Identifier: GPL-3.0-or-later
#include "welded_mesh.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <tuple>
#include <utility>

namespace vmap {
namespace {

using Imath::V3d;
using Imath::V3f;

struct Vertex {
    V3f position;
    std::uint32_t number = 0;

    [[nodiscard]] bool is_at(const Vertex& other) const { return position == other.position; }
    [[nodiscard]] bool operator<(const Vertex& other) const {
        return std::tie(position.x, position.y, position.z, number) <
               std::tie(other.position.x, other.position.y, other.position.z, other.number);
    }
};

}  // namespace

WeldedVertices::WeldedVertices(const Scene& scene, const V3d& origin) : scene_(&scene), first_{0} {
    for (const Instance& instance : scene.instances)
        first_.push_back(first_.back() + scene.meshes[instance.mesh].positions.size());

    std::vector<Vertex> vertices(first_.back());
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        const std::vector<V3f>& positions = scene.meshes[instance.mesh].positions;
        tbb::parallel_for(std::size_t{0}, positions.size(), [&](std::size_t k) {
            const V3d place = V3d(positions[k]) * instance.world_from_mesh - origin;
            vertices[first_[i] + k] = {.position = V3f(place), .number = static_cast<std::uint32_t>(first_[i] + k)};
        });
    }
    tbb::parallel_sort(vertices);

    number_.resize(vertices.size());
    std::uint32_t same_as = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        if (i == 0 || !vertices[i].is_at(vertices[i - 1])) same_as = vertices[i].number;
        number_[vertices[i].number] = same_as;
    }
}

std::array<std::uint32_t, 3> WeldedVertices::of(std::size_t instance, std::size_t triangle) const {
    const std::uint32_t* index = &scene_->meshes[scene_->instances[instance].mesh].indices[3 * triangle];
    const std::size_t first = first_[instance];
    return {number_[first + index[0]], number_[first + index[1]], number_[first + index[2]]};
}

TriangleEdge triangle_edge(std::uint32_t triangle, int corner, std::uint32_t from, std::uint32_t to) {
    const bool is_ascending = from < to;
    if (!is_ascending) std::swap(from, to);
    return {.vertices = static_cast<std::uint64_t>(from) << 32 | to,
            .triangle = triangle,
            .corner = static_cast<std::uint8_t>(corner),
            .is_ascending = is_ascending};
}

}  // namespace vmap
