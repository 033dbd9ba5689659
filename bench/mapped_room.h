// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A room with its visibility map under one rule, and questions about it that are the same for all who answer.
#pragma once

#include "rooms.h"

#include <vmap/patch.h>
#include <vmap/query_vmap.h>
#include <vmap/tree.h>
#include <vmap/visibility_map.h>

#include <Imath/ImathVec.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace vmap::bench {

/// What a map is made of, next to the cloud. Seconds are those of the processor, all threads together, over two cores:
/// what a machine of two cores that does nothing else takes. The best of several rounds.
struct MappedRoom {
    Tree tree;
    PatchSet patches;
    VisibilityMap map;
    double patch_seconds = 0;  ///< for finding patches, rule `patch` only
    double tree_seconds = 0;
    double map_seconds = 0;
};

/// - leaves: about so many
/// - rounds: how often the tree and the map are built
[[nodiscard]] MappedRoom map_room(const PointCloud& cloud, VisibilityRule rule, std::size_t leaves, int rounds,
                                  std::uint32_t few_patches = 0);

struct PointPair {
    std::uint32_t x = 0;
    std::uint32_t y = 0;
};

/// Pairs of random points that face each other, each seen from the other under less than 89.9 degrees.
[[nodiscard]] std::vector<PointPair> random_facing_pairs(const PointCloud& cloud, std::size_t count);

struct SampleRay {
    Imath::V3f from;  ///< relative to the cloud's origin
    Imath::V3f direction;
};

/// Rays from random places in the room's box in random directions, both uniform.
[[nodiscard]] std::vector<SampleRay> random_rays(const Room& room, std::size_t count);

/// Where segments and rays of other methods leave each point, so that its neighbours do not hide it.
[[nodiscard]] std::vector<Imath::V3f> lifted_points(const Room& room, double spacings);

/// Processor seconds of the calling thread.
[[nodiscard]] double thread_seconds();

/// Processor seconds of this process, all threads.
[[nodiscard]] double process_seconds();

}  // namespace vmap::bench
