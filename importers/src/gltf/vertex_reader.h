// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The vertices of one primitive: attributes from accessors or from a Draco mesh, checked, with morph targets applied.
#pragma once

#include "accessor.h"
#include "buffers.h"
#include "document.h"
#include "draco.h"

#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vmap::gltf {

class VertexReader {
public:
    /// - weights: of the morph targets; one for each
    /// - throws BrokenContent when an accessor of an attribute does not suit it
    VertexReader(const Document& document, const Primitive& primitive, const std::vector<double>& weights,
                 Buffers& buffers);

    /// Number of stored vertices; 0 without positions.
    [[nodiscard]] std::uint64_t stored_count() const { return count_; }

    /// The vertices that make the primitive up, in order: its indices, or all.
    [[nodiscard]] std::vector<std::uint32_t> sequence();

    /// Leaves out vertices that the sequence does not name, from now on, and renumbers it to fit.
    void keep_used(std::vector<std::uint32_t>& sequence);

    [[nodiscard]] std::size_t size() const { return selection_.size(count_); }

    /// Attributes of the vertices that are kept; empty when the primitive has none of that name.
    /// - throws BrokenContent for values that are not finite; normals may be anything
    [[nodiscard]] std::vector<Imath::V3f> positions();
    [[nodiscard]] std::vector<Imath::V3f> vectors(const std::string& name);
    [[nodiscard]] std::vector<Imath::V3f> normals();
    [[nodiscard]] std::vector<Imath::V2f> texcoords(std::size_t set);
    [[nodiscard]] std::vector<Imath::C4f> colors();
    /// Four joints and weights a vertex in each of the sets; the matrices of all of them averaged for each vertex.
    [[nodiscard]] std::vector<Imath::M44d> blend(const std::vector<Imath::M44d>& joints);

private:
    struct Shape;  // what an attribute's accessor may look like

    [[nodiscard]] std::string place(const std::string& attribute) const;
    void check_counts() const;
    void check_shape(const Accessor& accessor, const std::string& name, const Shape& shape) const;
    [[nodiscard]] std::optional<Elements> find(const std::string& name, const Shape& shape);
    [[nodiscard]] std::vector<float> read(const std::string& name, const Shape& shape, float missing);
    void add_targets(const std::string& name, const Shape& shape, std::vector<float>& values);
    void check_finite(const std::string& name, const std::vector<float>& values) const;

    const Document& document_;
    const Primitive& primitive_;
    const std::vector<double>& weights_;
    Buffers& buffers_;
    std::optional<DracoMesh> draco_;
    std::uint64_t count_ = 0;
    Selection selection_;
};

}  // namespace vmap::gltf
