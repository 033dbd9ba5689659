// SPDX-License-Identifier: GPL-3.0-or-later
#include <reference/ray_scene.h>

#include <Imath/ImathBox.h>
#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace vmap::reference {
namespace {

using Imath::V3d;
using Imath::V3f;

/// Rounding of Embree's floats in units of the largest coordinate, with a good reserve.
constexpr double rounding = 4e-6;

/// What competes for being met first when sheets lie in one place.
enum class Claim { none, lit, emits };

/// Embree hands the context of a query back to the filters.
struct Query : RTCIntersectContext {
    explicit Query(const RayScene& traced) : scene(&traced) { rtcInitIntersectContext(this); }

    const RayScene* scene;
    V3d direction{0, 0, 0};
    std::uint32_t face = RTC_INVALID_GEOMETRY_ID;
    Claim claim = Claim::none;
    double distance = 0;
    V3d barycentric{0, 0, 0};
};

V3d barycentric_of(float u, float v) {
    return {1.0 - u - v, u, v};
}

double largest_coordinate(const std::array<V3d, 3>& triangle) {
    double largest = 0;
    for (const V3d& vertex : triangle)
        largest = std::max({largest, std::abs(vertex.x), std::abs(vertex.y), std::abs(vertex.z)});
    return largest;
}

bool is_front(const RayScene& scene, std::uint32_t face, const V3d& direction) {
    return scene.front_normal(face).dot(direction) < 0;
}

bool is_cut(const RayScene& scene, std::uint32_t face, float u, float v) {
    return scene.shading().is_cut(scene.place(face, barycentric_of(u, v)));
}

Claim claim_of(const RayScene& scene, std::uint32_t face, const V3d& direction) {
    const Material& material = scene.shading().material(scene.place(face, V3d(1.0 / 3)));
    if (!material.double_sided && !is_front(scene, face, direction)) return Claim::none;
    return material.emits() ? Claim::emits : Claim::lit;
}

/// Keeps the hit if it is the nearest so far or wins among sheets in one place; leaves the ray just long enough for
/// other sheets to be found there.
void keep_first(const RTCFilterFunctionNArguments* arguments) {
    auto& query = static_cast<Query&>(*arguments->context);
    const RayScene& scene = *query.scene;
    const std::uint32_t face = RTCHitN_primID(arguments->hit, 1, 0);
    const float u = RTCHitN_u(arguments->hit, 1, 0);
    const float v = RTCHitN_v(arguments->hit, 1, 0);
    float& ray_end = RTCRayN_tfar(arguments->ray, 1, 0);
    if (is_cut(scene, face, u, v)) {
        arguments->valid[0] = 0;
        return;
    }

    const double distance = ray_end;
    const Claim claim = claim_of(scene, face, query.direction);
    bool better = query.face == RTC_INVALID_GEOMETRY_ID;
    if (!better) {
        const V3d kept_normal = scene.front_normal(query.face);
        const bool parallel = std::abs(kept_normal.dot(scene.front_normal(face))) > 1 - 1e-6;
        const double apart = std::abs((distance - query.distance) * kept_normal.dot(query.direction));
        const double tolerance = std::max(scene.offset(face), scene.offset(query.face)) / 2;
        const bool together = parallel && apart < tolerance;
        if (together && claim != query.claim)
            better = claim > query.claim;
        else
            better = distance < query.distance || (distance == query.distance && face < query.face);
    }
    if (better) {
        query.face = face;
        query.claim = claim;
        query.distance = distance;
        query.barycentric = barycentric_of(u, v);
    }
    const double incidence = std::abs(scene.front_normal(query.face).dot(query.direction));
    ray_end = static_cast<float>(query.distance + scene.offset() / std::max(incidence, 1e-3));
}

void let_light_through_cuts(const RTCFilterFunctionNArguments* arguments) {
    const RayScene& scene = *static_cast<Query&>(*arguments->context).scene;
    if (is_cut(scene, RTCHitN_primID(arguments->hit, 1, 0), RTCHitN_u(arguments->hit, 1, 0),
               RTCHitN_v(arguments->hit, 1, 0)))
        arguments->valid[0] = 0;
}

RTCRay ray_from(const V3d& origin, const V3d& direction, double length) {
    RTCRay ray{};
    ray.org_x = static_cast<float>(origin.x);
    ray.org_y = static_cast<float>(origin.y);
    ray.org_z = static_cast<float>(origin.z);
    ray.dir_x = static_cast<float>(direction.x);
    ray.dir_y = static_cast<float>(direction.y);
    ray.dir_z = static_cast<float>(direction.z);
    ray.tfar = static_cast<float>(length);
    ray.mask = ~0U;
    return ray;
}

}  // namespace

struct RayScene::Embree {
    RTCDevice device = rtcNewDevice(nullptr);
    RTCScene scene = rtcNewScene(device);

    Embree() = default;
    Embree(const Embree&) = delete;
    Embree& operator=(const Embree&) = delete;
    ~Embree() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }

    void add(const std::vector<V3f>& vertices, const std::vector<std::array<std::uint32_t, 3>>& triangles,
             bool has_cuts) const {
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        // Embree reads vertices in steps of 16 bytes, so it makes its own buffer with the padding that it needs.
        auto* positions = static_cast<V3f*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                                    RTC_FORMAT_FLOAT3, sizeof(V3f), vertices.size()));
        if (positions != nullptr) std::copy(vertices.begin(), vertices.end(), positions);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, triangles.data(), 0,
                                   sizeof triangles[0], triangles.size());
        rtcSetGeometryIntersectFilterFunction(geometry, keep_first);
        if (has_cuts) rtcSetGeometryOccludedFilterFunction(geometry, let_light_through_cuts);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
        rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
        rtcCommitScene(scene);
        const RTCError error = rtcGetDeviceError(device);
        if (error != RTC_ERROR_NONE) throw std::runtime_error("embree: error " + std::to_string(error));
    }
};

RayScene::RayScene(const Scene& scene)
    : shading_(scene), first_faces_(first_faces(scene)), embree_(std::make_unique<Embree>()) {
    Imath::Box3d box;
    for (const Instance& instance : scene.instances)
        for (const V3f& p : scene.meshes[instance.mesh].positions) box.extendBy(V3d(p) * instance.world_from_mesh);
    if (box.isEmpty()) return;
    origin_ = box.center();

    bool has_cuts = false;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        const Mesh& mesh = scene.meshes[instance.mesh];
        const auto base = static_cast<std::uint32_t>(vertices_.size());
        for (const V3f& p : mesh.positions) vertices_.emplace_back(V3d(p) * instance.world_from_mesh - origin_);
        for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
            triangles_.push_back(
                {base + mesh.indices[3 * t], base + mesh.indices[3 * t + 1], base + mesh.indices[3 * t + 2]});
            offsets_.push_back(static_cast<float>(
                rounding * largest_coordinate(triangle(static_cast<std::uint32_t>(offsets_.size())))));
            offset_ = std::max<double>(offset_, offsets_.back());
            normals_.push_back(world_area_normal(scene, i, t).normalized());
            instance_of_face_.push_back(static_cast<std::uint32_t>(i));
        }
        has_cuts = has_cuts || scene.materials[mesh.material].alpha_mode == AlphaMode::mask;
    }
    embree_->add(vertices_, triangles_, has_cuts);
}

RayScene::~RayScene() = default;

SurfacePlace RayScene::place(std::uint32_t face, const V3d& barycentric) const {
    const std::uint32_t instance = instance_of_face_[face];
    return {.instance = instance, .triangle = face - first_faces_[instance], .barycentric = barycentric, .width = 0};
}

std::array<V3d, 3> RayScene::triangle(std::uint32_t face) const {
    const auto& [a, b, c] = triangles_[face];
    return {V3d(vertices_[a]), V3d(vertices_[b]), V3d(vertices_[c])};
}

bool RayScene::is_lit_side(std::uint32_t face, bool front) const {
    return front || shading_.material(place(face, V3d(1.0 / 3))).double_sided;
}

std::optional<RayHit> RayScene::first_hit(const V3d& origin, const V3d& direction) const {
    Query query(*this);
    query.direction = direction;
    RTCRayHit ray{};
    ray.ray = ray_from(origin, direction, std::numeric_limits<double>::infinity());
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(embree_->scene, &query, &ray);
    if (query.face == RTC_INVALID_GEOMETRY_ID) return std::nullopt;

    RayHit hit;
    hit.face = query.face;
    hit.place = place(query.face, query.barycentric);
    const auto [a, b, c] = triangle(query.face);
    hit.position = a * query.barycentric.x + b * query.barycentric.y + c * query.barycentric.z;
    const bool front = is_front(*this, query.face, direction);
    hit.normal = front ? normals_[query.face] : -normals_[query.face];
    hit.lit_side = is_lit_side(query.face, front);
    return hit;
}

bool RayScene::is_blocked(const V3d& from, const V3d& to) const {
    const V3d way = to - from;
    const double length = way.length();
    if (!(length > 0)) return false;
    Query query(*this);
    RTCRay ray = ray_from(from, way / length, length);
    rtcOccluded1(embree_->scene, &query, &ray);
    return ray.tfar < 0;
}

bool RayScene::is_blocked_to_infinity(const V3d& from, const V3d& direction) const {
    Query query(*this);
    RTCRay ray = ray_from(from, direction, std::numeric_limits<double>::infinity());
    rtcOccluded1(embree_->scene, &query, &ray);
    return ray.tfar < 0;
}

}  // namespace vmap::reference
