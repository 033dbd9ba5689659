// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How often answers about pairs of points are wrong, the triangles that the points were sampled from being the truth.
#pragma once

#include "embree_peer.h"
#include "mapped_room.h"

#include <cstddef>
#include <functional>
#include <vector>

namespace vmap::bench {

/// Pairs with the answers of the triangles.
class MeshTruth {
public:
    MeshTruth(const Room& room, std::vector<PointPair> pairs);

    /// Share of the pairs near a silhouette: the answer changes when an end moves by one spacing along its surface.
    [[nodiscard]] double share_near_silhouettes() const;

    struct Wrong {
        double all = 0;   ///< share of the pairs
        double away = 0;  ///< share of the pairs away from silhouettes
    };
    [[nodiscard]] Wrong wrong(const std::function<bool(const PointPair&)>& sees) const;

    /// Whether nothing lies between two points.
    [[nodiscard]] bool sees(const PointPair& pair) const;

private:
    [[nodiscard]] bool is_near_silhouette(const PointPair& pair) const;

    const Room& room_;
    EmbreePeer triangles_;
    std::vector<Imath::V3f> lifted_;
    std::vector<PointPair> pairs_;
    std::vector<bool> seen_;
    std::vector<bool> near_;
};

/// Share of the links, each tried with one random point of either end, whose points the triangles hide from each other.
[[nodiscard]] double broken_links(const MeshTruth& truth, const MappedRoom& mapped, std::size_t count);

}  // namespace vmap::bench
