// SPDX-License-Identifier: GPL-3.0-or-later
#include "embree_peer.h"

#include <array>
#include <cmath>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace vmap::bench {
namespace {

using Imath::V3d;
using Imath::V3f;

template <class T>
std::span<T> new_buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::size_t count) {
    auto* data = static_cast<T*>(rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(T), count));
    if (data == nullptr) throw std::bad_alloc();
    return {data, count};
}

void attach(RTCScene scene, RTCGeometry geometry) {
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
}

RTCRay make_ray(const V3f& from, const V3f& direction, float end) {
    RTCRay ray{};
    ray.org_x = from.x;
    ray.org_y = from.y;
    ray.org_z = from.z;
    ray.dir_x = direction.x;
    ray.dir_y = direction.y;
    ray.dir_z = direction.z;
    ray.tfar = end;
    ray.mask = ~0U;
    return ray;
}

}  // namespace

EmbreePeer::EmbreePeer(const Room& room, Of what) : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    if (what == Of::discs)
        add_discs(room);
    else
        add_triangles(room);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
    if (what == Of::truth) rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(scene_);
    if (const RTCError error = rtcGetDeviceError(device_); error != RTC_ERROR_NONE)
        throw std::runtime_error("embree: error " + std::to_string(error));
}

EmbreePeer::~EmbreePeer() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
}

void EmbreePeer::add_discs(const Room& room) const {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT);
    const PointCloud& cloud = room.cloud;
    const auto discs =
        new_buffer<std::array<float, 4>>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, cloud.size());
    const auto normals = new_buffer<V3f>(geometry, RTC_BUFFER_TYPE_NORMAL, RTC_FORMAT_FLOAT3, cloud.size());
    const auto radius = static_cast<float>(room.spacing() / std::sqrt(2.0));
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const V3f& p = cloud.positions[i];
        discs[i] = {p.x, p.y, p.z, radius};
        normals[i] = cloud.normals[i];
    }
    attach(scene_, geometry);
}

void EmbreePeer::add_triangles(const Room& room) const {
    std::vector<V3f> vertices;
    std::vector<std::uint32_t> indices;
    for (const Instance& instance : room.scene.instances) {
        const Mesh& mesh = room.scene.meshes[instance.mesh];
        const auto base = static_cast<std::uint32_t>(vertices.size());
        for (const V3f& p : mesh.positions)
            vertices.emplace_back(V3d(p) * instance.world_from_mesh - room.cloud.origin);
        for (const std::uint32_t i : mesh.indices) indices.push_back(base + i);
    }
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    const auto positions = new_buffer<V3f>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, vertices.size());
    std::copy(vertices.begin(), vertices.end(), positions.begin());
    const auto triangles =
        new_buffer<std::array<std::uint32_t, 3>>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, indices.size() / 3);
    for (std::size_t t = 0; t < triangles.size(); ++t)
        triangles[t] = {indices[3 * t], indices[3 * t + 1], indices[3 * t + 2]};
    attach(scene_, geometry);
}

bool EmbreePeer::is_blocked(const V3f& from, const V3f& to) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray = make_ray(from, to - from, 1);
    rtcOccluded1(scene_, &context, &ray);
    return ray.tfar < 0;
}

float EmbreePeer::first_hit(const V3f& from, const V3f& direction) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit ray{};
    ray.ray = make_ray(from, direction, std::numeric_limits<float>::infinity());
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &context, &ray);
    return ray.hit.geomID == RTC_INVALID_GEOMETRY_ID ? std::numeric_limits<float>::infinity() : ray.ray.tfar;
}

}  // namespace vmap::bench
