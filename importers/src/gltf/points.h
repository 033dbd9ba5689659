// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Primitives of mode POINTS as one cloud of points.
#pragma once

#include "buffers.h"
#include "document.h"

#include <vmap/importers/input.h>

#include <Imath/ImathMatrix.h>

#include <optional>
#include <string>
#include <vector>

namespace vmap::gltf {

class PointCollector {
public:
    PointCollector(const Document& document, Buffers& buffers, Warnings& warnings)
        : document_(document), buffers_(buffers), warnings_(warnings) {}

    /// Adds a primitive.
    ///
    /// - weights: of its morph targets
    void add(const MeshInfo& mesh, const Primitive& primitive, const std::vector<double>& weights,
             const Imath::M44d& world_from_mesh);

    /// All points, with the attributes that every primitive has; nothing when there are none.
    [[nodiscard]] std::optional<PointFile> finish();

private:
    /// One attribute of all points so far.
    template <class Value>
    struct Column {
        std::vector<Value> values;
        bool complete = true;  // no primitive lacked it
    };

    template <class Value, class Source, class Convert>
    void append(Column<Value>& column, const std::vector<Source>& source, const std::vector<std::uint32_t>& sequence,
                const Convert& convert) const;
    template <class Value>
    [[nodiscard]] std::vector<Value> take(Column<Value>& column) const;
    [[nodiscard]] std::vector<float> areas_of(const MeshInfo& mesh, const Primitive& primitive,
                                              std::uint64_t stored_count);
    [[nodiscard]] std::vector<Imath::C3f> albedo_of(const Primitive& primitive, class VertexReader& reader);

    const Document& document_;
    Buffers& buffers_;
    Warnings& warnings_;
    Imath::V3d origin_;  // of the first primitive, in the frame of the file, whose up axis may be z
    std::vector<Imath::V3f> positions_;
    Column<Imath::V3f> normals_;
    Column<float> areas_;
    Column<Imath::C3f> albedo_;
    Column<Imath::C3f> emission_;
    Column<Imath::C3f> irradiance_;
};

}  // namespace vmap::gltf
