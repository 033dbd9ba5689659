// SPDX-License-Identifier: GPL-3.0-or-later
#include "instancing.h"

#include "../content_error.h"
#include "accessor.h"
#include "limits.h"
#include "transform.h"

#include <Imath/ImathQuat.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

namespace vmap::gltf {
namespace {

using Imath::M44d;

/// Values of one attribute; empty when there is none.
std::vector<float> read(const Document& document, const std::optional<std::size_t>& index, std::string_view type,
                        Buffers& buffers) {
    if (!index) return {};
    const Accessor& accessor = document.accessors[*index];
    if (accessor.type != type)
        throw BrokenContent(fmt::format("EXT_mesh_gpu_instancing uses accessors[{}] of type {}, expected {}", *index,
                                        accessor.type, type));
    buffers.spend(accessor.count, accessor.components * sizeof(float));
    std::vector<float> values(accessor.count * accessor.components);
    read_floats(open_accessor(accessor, buffers), {}, accessor.components, values);
    if (!std::all_of(values.begin(), values.end(), [](float value) { return std::isfinite(value); }))
        throw BrokenContent(fmt::format("accessors[{}] has a value that is not finite", *index));
    return values;
}

std::uint64_t instance_count(const Document& document, const InstancingInfo& instancing) {
    std::uint64_t count = 0;
    for (const auto& index : {instancing.translation, instancing.rotation, instancing.scale}) {
        if (!index) continue;
        const std::uint64_t own = document.accessors[*index].count;
        if (count != 0 && count != own)
            throw BrokenContent("EXT_mesh_gpu_instancing has attributes of different lengths");
        count = own;
    }
    if (count == 0) throw BrokenContent("EXT_mesh_gpu_instancing has none of TRANSLATION, ROTATION and SCALE");
    if (count > most_instances) throw UnsupportedContent(fmt::format("places more than {} meshes", most_instances));
    return count;
}

}  // namespace

std::vector<M44d> instance_matrices(const Document& document, const InstancingInfo& instancing,
                                    const M44d& world_from_node, Buffers& buffers) {
    const std::uint64_t count = instance_count(document, instancing);
    const std::vector<float> t = read(document, instancing.translation, "VEC3", buffers);
    const std::vector<float> r = read(document, instancing.rotation, "VEC4", buffers);
    const std::vector<float> s = read(document, instancing.scale, "VEC3", buffers);
    std::vector<M44d> matrices;
    matrices.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        Transform transform;
        for (std::size_t k = 0; k < 3; ++k) {
            if (!t.empty()) transform.translation[k] = t[3 * i + k];
            if (!s.empty()) transform.scale[k] = s[3 * i + k];
        }
        if (!r.empty()) {
            // Quantised: brought back to unit length, because nothing bounds how far they are off.
            const Imath::Quatd q = Imath::Quatd(r[4 * i + 3], r[4 * i], r[4 * i + 1], r[4 * i + 2]).normalized();
            transform.rotation = {q.v.x, q.v.y, q.v.z, q.r};
        }
        matrices.push_back(matrix_of(transform) * world_from_node);
    }
    return matrices;
}

}  // namespace vmap::gltf
