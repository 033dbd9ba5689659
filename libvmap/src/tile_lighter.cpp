// SPDX-License-Identifier: Apache-2.0
#include "tile_lighter.h"

#include "channel_mean.h"
#include "sampling.h"
#include "shaft.h"

#include <vmap/polygon_light.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace vmap {
namespace {

using Imath::Box3f;
using Imath::C3f;
using Imath::V3d;
using Imath::V3f;

constexpr std::size_t exact_blockers = 12;       ///< with more of them shadow rays are cheaper than clipping
constexpr std::uint32_t most_shadow_rays = 128;  ///< of a point towards all that lies behind blockers, by their shares
constexpr std::uint32_t least_shadow_rays = 4;
constexpr double least_exact_share = 0.02;         ///< lights that bring less are not worth clipping
constexpr std::uint32_t least_cluster = 4;         ///< fewer lights are taken one by one
constexpr std::uint32_t most_summed_members = 64;  ///< of a cluster that faces the tile in part

std::uint32_t shadow_rays(double share) {
    return static_cast<std::uint32_t>(
        std::clamp(std::ceil(4 * most_shadow_rays * share), 1.0 * least_shadow_rays, 1.0 * most_shadow_rays));
}

float distance_to(const Box3f& box, const V3f& place) {
    V3f away(0);
    for (int axis = 0; axis < 3; ++axis)
        away[axis] = std::max({box.min[axis] - place[axis], 0.0F, place[axis] - box.max[axis]});
    return away.length();
}

}  // namespace

Lights::Lights(std::span<const Emitter> emissive, std::span<const LightSource> punctual, const V3d& origin)
    : emitters(emissive), sources(punctual) {
    std::vector<FarLight> surfaces;
    for (const Emitter& emitter : emitters)
        surfaces.push_back({emitter.bounds.center(), emitter.normal, emitter.radiance * emitter.area, emitter.bounds,
                            emitter.patch, emitter.turn});
    emitter_tree = LightTree(std::move(surfaces));
    std::vector<FarLight> places;
    for (std::uint32_t i = 0; i < sources.size(); ++i) {
        if (sources[i].kind != LightKind::point) {
            singles.push_back(i);
            continue;
        }
        const V3f place(sources[i].position - origin);
        places.push_back({place, V3f(0), sources[i].intensity, {place, place}});
        points.push_back(i);
    }
    source_tree = LightTree(std::move(places));
}

TileLighter::TileLighter(const Surface& surface, const Tile& tile, const Lights& lights, double tolerance,
                         std::uint64_t seed, std::span<C3f> irradiance)
    : surface_(surface),
      tile_(tile),
      patch_(surface.set.patches[tile.patch]),
      lights_(lights),
      opening_(static_cast<float>(std::clamp(1.2 * std::sqrt(tolerance), 0.05, 0.3))),
      clearance_(patch_.flat ? 4e-6F * surface.diagonal : 0.35F * patch_.spacing()),
      seed_(seed),
      irradiance_(irradiance) {}

void TileLighter::run() {
    choose_parts(lights_.emitter_tree);
    choose_parts(lights_.source_tree);
    double total = 0;
    for (const Part& part : parts_) total += part.strength;
    for (const Part& part : parts_) add_part(part, total > 0 ? part.strength / total : 0);
    for (const std::uint32_t i : lights_.singles) add(lights_.sources[i]);
}

/// The nodes that are one light as seen from here: single ones, and those far away.
void TileLighter::choose_parts(const LightTree& tree) {
    if (tree.empty()) return;
    std::vector<std::uint32_t> open{0};
    while (!open.empty()) {
        const std::uint32_t index = open.back();
        open.pop_back();
        const LightTree::Node& node = tree.nodes()[index];
        if (is_out_of_sight(node)) continue;
        const bool whole =
            node.count >= least_cluster && is_far(node) && (node.count <= most_summed_members || faces_the_tile(node));
        if (node.right != 0 && !whole) {
            open.push_back(node.right);
            open.push_back(index + 1);
            continue;
        }
        const float distance = std::max(distance_to(tile_.bounds, node.center), node.radius);
        const double strength = static_cast<double>(mean_of(node.power)) /
                                std::max(static_cast<double>(distance) * static_cast<double>(distance), 1e-30);
        parts_.push_back({&tree, index, strength});
    }
}

void TileLighter::add_part(const Part& part, double share) {
    const LightTree::Node& node = part.tree->nodes()[part.node];
    if (node.count > 1) {
        add_cluster(*part.tree, node, share);
        return;
    }
    const std::uint32_t member = part.tree->members(node)[0];
    if (part.tree == &lights_.emitter_tree)
        add(lights_.emitters[member], node, share);
    else
        add(lights_.sources[lights_.points[member]]);
}

void TileLighter::add(const Emitter& emitter, const LightTree::Node& node, double share) {
    if (emitter.patch == tile_.patch) return;
    find_blockers(emitter.bounds, [&](std::uint32_t other, std::span<const V3f> outline) {
        return other != emitter.patch && rises_over(emitter, outline);
    });
    // Blockers cut the light where the emitter's own neighbours no longer reach.
    Outline lifted = emitter.vertices;
    for (V3d& v : lifted) v += V3d(emitter.normal) * static_cast<double>(emitter.lift);
    const bool exactly = blockers_.size() <= exact_blockers && share >= least_exact_share;
    const bool as_place = share < least_exact_share && is_far(node);
    const auto unblocked = [&](const V3d& position, const V3d& normal) {
        const V3d way = V3d(node.center) - position;
        const double square = way.length2();
        const double length = std::sqrt(square);
        const auto cosine = static_cast<float>(-V3d(emitter.normal).dot(way) / length);
        if (!as_place && cosine >= emitter.turn) return polygon_irradiance(position, normal, emitter.vertices);
        return static_cast<double>(emitter.area * emitted_cosine(cosine, emitter.turn)) *
               std::max(normal.dot(way), 0.0) / (square * length);
    };
    for_each_point([&](std::uint32_t i, const V3d& position, const V3d& normal) {
        double light = unblocked(position, normal);
        if (light <= 0) return;
        if (!blockers_.empty()) {
            std::optional<double> exact;
            const double whole = emitter.lift > 0 ? polygon_irradiance(position, normal, lifted) : light;
            if (exactly && whole > 0)
                exact =
                    visible_polygon_irradiance(position, normal, lifted, blockers_, static_cast<double>(clearance_));
            light *= exact ? *exact / whole
                           : visible_share(lights_.emitter_tree, node, i, position, normal, shadow_rays(share));
        }
        irradiance_[i] += emitter.radiance * static_cast<float>(light);
    });
}

void TileLighter::add(const LightSource& source) {
    const bool sun = source.kind == LightKind::sun;
    const V3d place = source.position - surface_.cloud.origin;
    Box3f end(V3f{place});
    if (sun) {
        const V3f away = V3f(source.direction) * (-2 * surface_.diagonal);
        end = {tile_.bounds.min + away, tile_.bounds.max + away};
    }
    find_blockers(end, [](std::uint32_t, std::span<const V3f>) { return true; });
    for_each_point([&](std::uint32_t i, const V3d& position, const V3d& normal) {
        const V3d to_light =
            sun ? -source.direction * (2.0 * static_cast<double>(surface_.diagonal)) : place - position;
        const double distance = to_light.length();
        if (!(distance > 0)) return;
        double light = normal.dot(to_light) / distance;
        if (light <= 0) return;
        if (!sun) light /= distance * distance;
        if (source.kind == LightKind::spot) light *= spot_falloff(source, -source.direction.dot(to_light) / distance);
        if (light <= 0) return;
        if (!blockers_.empty()) {
            const V3d start = position + normal * static_cast<double>(clearance_);
            if (surface_.bvh.any_hit({V3f(start), V3f(position + to_light - start), 0, 1 - 1e-5F})) return;
        }
        irradiance_[i] += source.intensity * static_cast<float>(light);
    });
}

/// Lights close together and far away: their sum from one place, as far as rays to some of them get through.
void TileLighter::add_cluster(const LightTree& tree, const LightTree::Node& node, double share) {
    const std::span<const std::uint32_t> members = tree.members(node);
    find_blockers(node.bounds, [&](std::uint32_t other, std::span<const V3f> outline) {
        if (!surface_.set.patches[other].emits || &tree != &lights_.emitter_tree ||
            members.size() > most_summed_members)
            return true;
        // A lamp that bulges hides nothing of itself that faces this way.
        return std::any_of(members.begin(), members.end(), [&](std::uint32_t m) {
            return tree.light(m).patch != other && rises_over(lights_.emitters[m], outline);
        });
    });
    const bool facing = faces_the_tile(node);
    for_each_point([&](std::uint32_t i, const V3d& position, const V3d& normal) {
        C3f light = far_light(tree, node, facing, V3f(position), V3f(normal));
        if (!(mean_of(light) > 0)) return;
        if (!blockers_.empty())
            light *= static_cast<float>(visible_share(tree, node, i, position, normal, shadow_rays(share)));
        irradiance_[i] += light;
    });
}

template <class Use>
void TileLighter::for_each_point(const Use& use) const {
    for (std::uint32_t k = tile_.first_point; k < tile_.first_point + tile_.point_count; ++k) {
        const std::uint32_t i = surface_.set.point_order[k];
        use(i, V3d(surface_.cloud.positions[i]), V3d(surface_.normal_of(patch_, i)));
    }
}

/// Collects the outlines that reach into the shaft from the tile to the box and above the tile's own surface.
template <class Keep>
void TileLighter::find_blockers(const Box3f& end, const Keep& keep) {
    const Shaft shaft(tile_.bounds, end);
    found_.clear();
    surface_.bvh.polygons_in(shaft.half_spaces(), found_);
    std::sort(found_.begin(), found_.end());
    blockers_.clear();
    for (const std::uint32_t other : found_) {
        if (other == tile_.patch) continue;
        const std::span<const V3f> outline = surface_.set.outlines[other];
        if (!keep(other, outline) || !shaft.may_hold(outline) || !rises_over_the_tile(outline)) continue;
        blockers_.emplace_back();
        for (const V3f& v : outline) blockers_.back().emplace_back(v);
    }
}

bool TileLighter::rises_over(const Emitter& emitter, std::span<const V3f> outline) const {
    const V3f foot(emitter.vertices[0]);
    const float level = std::max(emitter.lift, 4e-6F * surface_.diagonal);
    return std::any_of(outline.begin(), outline.end(),
                       [&](const V3f& v) { return emitter.normal.dot(v - foot) > level; });
}

bool TileLighter::rises_over_the_tile(std::span<const V3f> outline) const {
    if (patch_.flat)
        return std::any_of(outline.begin(), outline.end(),
                           [&](const V3f& v) { return patch_.normal.dot(v - patch_.center) > clearance_; });
    for (std::uint32_t k = tile_.first_point; k < tile_.first_point + tile_.point_count; ++k) {
        const std::uint32_t i = surface_.set.point_order[k];
        for (const V3f& v : outline)
            if (surface_.cloud.normals[i].dot(v - surface_.cloud.positions[i]) > clearance_) return true;
    }
    return false;
}

/// Below the tile's horizon, or behind all of its own members.
bool TileLighter::is_out_of_sight(const LightTree::Node& node) const {
    const float touch = 4e-6F * surface_.diagonal;
    const auto foremost = [](const Box3f& box, const V3f& direction) {
        V3f corner = box.min;
        for (int axis = 0; axis < 3; ++axis)
            if (direction[axis] > 0) corner[axis] = box.max[axis];
        return corner;
    };
    if (patch_.flat && patch_.normal.dot(foremost(node.bounds, patch_.normal) - patch_.center) <= touch) return true;
    if (node.count == 1 && node.cone_angle < 1)
        return node.axis.dot(foremost(tile_.bounds, node.axis) - foremost(node.bounds, -node.axis)) <= touch;
    if (!(node.cone_angle < std::numbers::pi_v<float> / 2)) return false;
    const V3f way = tile_.bounds.center() - node.center;
    const float reach = node.radius + tile_.bounds.size().length() / 2;
    const float distance = way.length();
    if (!(distance > reach)) return false;
    const float off_axis = std::acos(std::clamp(node.axis.dot(way) / distance, -1.0F, 1.0F));
    return off_axis - node.cone_angle - std::asin(reach / distance) > std::numbers::pi_v<float> / 2;
}

bool TileLighter::is_far(const LightTree::Node& node) const {
    return node.radius < opening_ * distance_to(tile_.bounds, node.center);
}

/// Whether every point of the tile is in front of every member.
bool TileLighter::faces_the_tile(const LightTree::Node& node) const {
    if (node.axis == V3f(0)) return node.flow[0] == V3f(0) && node.flow[1] == V3f(0) && node.flow[2] == V3f(0);
    const V3f way = tile_.bounds.center() - node.center;
    const float reach = node.radius + tile_.bounds.size().length() / 2;
    const float distance = way.length();
    if (!(distance > reach)) return false;
    const float off_axis = std::acos(std::clamp(node.axis.dot(way) / distance, -1.0F, 1.0F));
    return off_axis + node.cone_angle + std::asin(reach / distance) < std::numbers::pi_v<float> / 2;
}

C3f TileLighter::far_light(const LightTree& tree, const LightTree::Node& node, bool facing, const V3f& position,
                           const V3f& normal) const {
    const bool directed = &tree == &lights_.emitter_tree;
    if (facing || !directed) {
        const V3f way = node.center - position;
        const float square = way.length2();
        const float rise = normal.dot(way);
        if (!(rise > 0)) return C3f(0, 0, 0);
        if (!directed) return node.power * (rise / (square * std::sqrt(square)));
        C3f light(0, 0, 0);
        for (int c = 0; c < 3; ++c)
            light[c] = std::max(-node.flow.at(static_cast<std::size_t>(c)).dot(way), 0.0F) * rise / (square * square);
        return light;
    }
    C3f light(0, 0, 0);
    for (const std::uint32_t m : tree.members(node)) {
        const FarLight& member = tree.light(m);
        const V3f way = member.center - position;
        const float square = way.length2();
        const float rise = normal.dot(way);
        if (!(rise > 0)) continue;
        const float length = std::sqrt(square);
        light +=
            member.power * (emitted_cosine(-member.normal.dot(way) / length, member.turn) * rise / (square * length));
    }
    return light;
}

V3d TileLighter::place_in(const LightTree& tree, std::uint32_t member, const Imath::V2d& sample) const {
    if (&tree != &lights_.emitter_tree) return V3d(tree.light(member).center);
    const Emitter& emitter = lights_.emitters[member];
    return place_on(emitter, sample) + V3d(emitter.normal) * static_cast<double>(emitter.lift);
}

/// Share of a node's light that shadow rays reach, each weighted by what it would bring.
double TileLighter::visible_share(const LightTree& tree, const LightTree::Node& node, std::uint32_t point,
                                  const V3d& position, const V3d& normal, std::uint32_t count) const {
    const V3d start = position + normal * static_cast<double>(clearance_);
    std::array<Ray, most_shadow_rays> rays;
    std::array<std::uint8_t, most_shadow_rays> blocked{};
    std::array<double, most_shadow_rays> weights{};
    const std::uint64_t key = hash64(seed_ ^ hash64((std::uint64_t{point} << 32) + node.first));
    const double shift = static_cast<double>(key >> 11) * 0x1p-53;
    for (std::uint32_t k = 0; k < count; ++k) {
        const std::uint32_t member = tree.member_at(node, (k + shift) / count);
        const V3d target = place_in(tree, member, shifted_r2(key, k));
        const V3d way = target - position;
        const FarLight& light = tree.light(member);
        const double square = way.length2();
        const double length = std::sqrt(square);
        const auto cosine = static_cast<float>(-V3d(light.normal).dot(way) / std::max(length, 1e-300));
        const double turned = light.normal == V3f(0) ? 1 : static_cast<double>(emitted_cosine(cosine, light.turn));
        weights.at(k) = std::max(normal.dot(way), 0.0) * turned / std::max(square * length, 1e-300);
        rays.at(k) = {V3f(start), V3f(target - start), 0, 1 - 1e-4F};
    }
    surface_.bvh.any_hits(std::span(rays).first(count), std::span(blocked).first(count));
    double seen = 0;
    double all = 0;
    for (std::uint32_t k = 0; k < count; ++k) {
        all += weights.at(k);
        if (blocked.at(k) == 0) seen += weights.at(k);
    }
    return all > 0 ? seen / all : 0;
}

}  // namespace vmap
