// SPDX-License-Identifier: Apache-2.0
/// \file
/// Discs that may block a shaft, laid out so that many are looked at together.
#pragma once

#include "node_bounds.h"

#include <vmap/leaf_visibility.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace vmap {

/// A disc with its plane and the leaf that it belongs to.
struct LoneDisc {
    LeafPlane plane;
    LeafDisc disc;
    std::uint32_t leaf = 0;
};

/// One array per attribute.
class DiscList {
public:
    enum Field : std::size_t {
        nx,
        ny,
        nz,
        offset,
        slab,
        ux,
        uy,
        uz,
        vx,
        vy,
        vz,
        du,
        dv,
        radius_squared,
        leaf,
        fields
    };  // as floats

    /// Room for so many discs, none of which is there yet.
    explicit DiscList(std::size_t capacity);
    explicit DiscList(std::span<const LoneDisc> discs);

    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] bool empty() const { return size_ == 0; }
    void set_size(std::size_t size) { size_ = size; }

    [[nodiscard]] float* field(Field f) { return values_.get() + f * stride_; }
    [[nodiscard]] const float* field(Field f) const { return values_.get() + f * stride_; }

    [[nodiscard]] LoneDisc at(std::size_t i) const;

private:
    std::size_t size_ = 0;
    std::size_t stride_ = 0;  ///< with spare elements, so that whole vectors can be read and written anywhere
    std::unique_ptr<float[]> values_;
};

/// Of the segment between the middles of two boxes: which discs of a list may it cross? Appends their leaves.
void find_on_middle(const DiscList& list, const Imath::V3f& from, const Imath::V3f& to,
                    std::vector<std::uint32_t>& leaves);

/// Puts into `left` the discs of the list that may block a segment between two boxes. The segments that cross a disc's
/// plane do so in a rectangle, the footprint of the shaft; the disc matters if it reaches into that.
///
/// - left: has room for all of the list
/// - cover_counts: a disc that every segment crosses blocks them all; not so on a uniform tree
/// - returns whether one disc blocks every segment; `left` then means nothing
[[nodiscard]] bool cull_discs(const DiscList& list, const TurnedBox& a, const TurnedBox& b, bool cover_counts,
                              DiscList& left);

}  // namespace vmap
