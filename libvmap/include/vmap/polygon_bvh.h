// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which polygon does a ray meet first, is a segment blocked, which polygons reach into a shaft: a bounding volume
/// hierarchy eight wide, its boxes and polygons tested eight at a time.
///
/// This work is based on:
///   I. Wald, "On fast construction of SAH-based bounding volume hierarchies", RT 2007 (binned build);
///   I. Wald, C. Benthin, S. Boulos, "Getting rid of packets", RT 2008 (wide nodes for single rays);
///   E. Haines, J. Wallace, "Shaft culling for efficient ray-traced radiosity", EGWR 1991 (shafts).
#pragma once

#include <vmap/polygon_set.h>

#include <Imath/ImathVec.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace vmap {

/// The open segment origin + t * direction for t_min < t < t_max. The direction need not have unit length.
struct Ray {
    Imath::V3f origin{0, 0, 0};
    Imath::V3f direction{0, 0, 1};
    float t_min = 0;
    float t_max = std::numeric_limits<float>::max();
};

struct RayHit {
    static constexpr std::uint32_t miss = std::numeric_limits<std::uint32_t>::max();

    float t = std::numeric_limits<float>::max();  ///< along the ray, in lengths of its direction
    std::uint32_t polygon = miss;                 ///< index into the set, or miss
    bool front = false;                           ///< the ray came from the side the polygon faces

    [[nodiscard]] explicit operator bool() const { return polygon != miss; }
};

/// Points x with normal.dot(x) <= offset.
struct HalfSpace {
    Imath::V3f normal;
    float offset;
};

struct PolygonBvhConfig {
    /// Each polygon grows outwards by this much in its plane, world units, so that neighbours leave no cracks. Empty:
    /// the rounding of the coordinates for every polygon; else one value per polygon.
    std::span<const float> dilation;
};

class PolygonBvh {
public:
    PolygonBvh() = default;

    /// Deterministic at any number of threads. The set is not kept.
    explicit PolygonBvh(const PolygonSet& polygons, const PolygonBvhConfig& config = {});

    /// The nearest polygon of every ray. Of two sheets in one place the one that faces the ray is hit.
    ///
    /// - hits: one per ray
    void first_hits(std::span<const Ray> rays, std::span<RayHit> hits) const;

    [[nodiscard]] RayHit first_hit(const Ray& ray) const {
        RayHit hit;
        first_hits({&ray, 1}, {&hit, 1});
        return hit;
    }

    /// Whether anything lies on each ray between t_min and t_max.
    ///
    /// - blocked: one byte per ray, 1 for blocked, 0 for free
    void any_hits(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const;

    [[nodiscard]] bool any_hit(const Ray& ray) const {
        std::uint8_t blocked = 0;
        any_hits({&ray, 1}, {&blocked, 1});
        return blocked != 0;
    }

    /// Appends every polygon whose bounding box may reach into the intersection of the half-spaces (conservative: some
    /// that do not reach in are listed too), in an order that depends on the set only.
    void polygons_in(std::span<const HalfSpace> shaft, std::vector<std::uint32_t>& found) const;

    [[nodiscard]] bool empty() const { return blocks_.empty(); }

    static constexpr std::size_t width = 8;

    /// Boxes of up to eight children. A child is a node, or a block when leaf_bit is set.
    struct alignas(64) Node {
        std::array<std::array<float, width>, 3> lower;
        std::array<std::array<float, width>, 3> upper;
        std::array<std::uint32_t, width> child;
    };

    /// Up to eight polygons: planes, and inward edge half-spaces in edges_ from first_edge on.
    struct alignas(64) Block {
        std::array<std::array<float, width>, 3> normal;
        std::array<float, width> offset;  ///< normal.dot(x) of the plane
        std::array<std::uint32_t, width> polygon;
        std::uint32_t first_edge;
        std::uint32_t edge_count;
    };

    /// One edge of each of the eight polygons: inside is normal.dot(x) >= offset.
    struct alignas(32) Edges {
        std::array<std::array<float, width>, 3> normal;
        std::array<float, width> offset;
    };

    static constexpr std::uint32_t leaf_bit = 0x80000000U;
    static constexpr std::uint32_t no_child = 0xFFFFFFFFU;

    /// The flat arrays that the kernels walk; nodes()[0] is the root.
    [[nodiscard]] std::span<const Node> nodes() const { return nodes_; }
    [[nodiscard]] std::span<const Block> blocks() const { return blocks_; }
    [[nodiscard]] std::span<const Edges> edges() const { return edges_; }
    /// Distance below which two sheets count as one, world units.
    [[nodiscard]] float coincidence() const { return coincidence_; }

private:
    std::vector<Node> nodes_;
    std::vector<Block> blocks_;
    std::vector<Edges> edges_;
    float coincidence_ = 0;
};

}  // namespace vmap
