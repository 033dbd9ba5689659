// SPDX-License-Identifier: GPL-3.0-or-later
#include "ply.h"

#include "../content_error.h"
#include "colors.h"
#include "ply_elements.h"
#include "ply_vertices.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>

namespace vmap {
namespace {

std::string format_name(PlyEncoding encoding) {
    if (encoding == PlyEncoding::ascii) return "PLY, text";
    return encoding == PlyEncoding::little_endian ? "PLY, binary little-endian" : "PLY, binary big-endian";
}

/// The list of vertices that an element has under one of the two usual names.
std::size_t find_vertex_list(const PlyElement& element) {
    std::optional<std::size_t> found = element.find("vertex_indices");
    if (!found) found = element.find("vertex_index");
    if (!found || !element.properties[*found].is_list())
        throw BrokenContent(fmt::format("the element '{}' has no list vertex_indices", element.name));
    if (!is_integer(element.properties[*found].type))
        throw BrokenContent(
            fmt::format("the list vertex_indices of '{}' has values that are no integers", element.name));
    return *found;
}

class FaceReader {
public:
    FaceReader(PolygonSoup& soup, std::uint64_t vertices) : soup_(soup), vertices_(vertices) {}

    void read_polygons(const PlyElement& element, PlyElements& elements) {
        const PlyList list{find_vertex_list(element), [&](std::span<const std::int64_t> face) { add_polygon(face); }};
        elements.expect_to_fit(element);
        std::vector<PlyColumn> columns;
        const auto red = element.find("red");
        const auto green = element.find("green");
        const auto blue = element.find("blue");
        const bool colored = red && green && blue && !element.properties[*red].is_list() &&
                             !element.properties[*green].is_list() && !element.properties[*blue].is_list();
        if (colored) {
            soup_.polygon_colors.resize(element.count);
            float* const first = &soup_.polygon_colors.data()->x;
            columns = {{*red, first, 3}, {*green, first + 1, 3}, {*blue, first + 2, 3}};
        }
        soup_.polygon_sizes.reserve(element.count);
        elements.read(element, columns, {&list, 1});
        if (colored) decode_ply_colors(element.properties[*red].type, soup_.polygon_colors);
    }

    void read_strips(const PlyElement& element, PlyElements& elements) {
        const PlyList list{find_vertex_list(element), [&](std::span<const std::int64_t> strip) { add_strip(strip); }};
        elements.read(element, {}, {&list, 1});
    }

private:
    void add_polygon(std::span<const std::int64_t> face) {
        for (const std::int64_t index : face) soup_.corners.push_back(checked(index));
        soup_.polygon_sizes.push_back(static_cast<std::uint32_t>(face.size()));
    }

    /// Every vertex after the second makes a triangle with the two before it, turned around every other time; -1 starts
    /// a new strip.
    void add_strip(std::span<const std::int64_t> strip) {
        std::size_t begin = 0;
        for (std::size_t i = 0; i < strip.size(); ++i) {
            if (strip[i] == -1) {
                begin = i + 1;
                continue;
            }
            const std::uint32_t newest = checked(strip[i]);
            if (i < begin + 2) continue;
            std::uint32_t a = checked(strip[i - 2]);
            std::uint32_t b = checked(strip[i - 1]);
            // A repeated vertex only turns the strip.
            if (a == b || b == newest || a == newest) continue;
            if ((i - begin) % 2 == 1) std::swap(a, b);
            soup_.corners.insert(soup_.corners.end(), {a, b, newest});
            soup_.polygon_sizes.push_back(3);
        }
    }

    [[nodiscard]] std::uint32_t checked(std::int64_t index) const {
        if (index < 0 || static_cast<std::uint64_t>(index) >= vertices_)
            throw BrokenContent(fmt::format("face {} uses vertex {}, but there are {} vertices from 0",
                                            soup_.polygon_sizes.size(), index, vertices_));
        return static_cast<std::uint32_t>(index);
    }

    PolygonSoup& soup_;
    std::uint64_t vertices_;
};

void warn_of_textures(const PlyHeader& header, MeshFile& file) {
    for (const std::string& comment : header.comments)
        if (comment.starts_with("TextureFile"))
            file.warnings.add("textures of PLY files are not read, only colours of vertices and faces");
}

}  // namespace

MeshFile read_ply(std::string_view text) {
    const PlyHeader header = read_ply_header(text);
    const PlyElement* vertex = header.find("vertex");
    if (vertex == nullptr) throw BrokenContent("the header has no element 'vertex'");
    if (vertex->count >= no_index)
        throw UnsupportedContent(
            fmt::format("holds {} vertices, more than the {} that are read", vertex->count, no_index - 1));

    MeshFile file;
    file.format = format_name(header.encoding);
    PlyElements elements(header, text);
    FaceReader faces(file.soup, vertex->count);
    for (const PlyElement& element : header.elements) {
        if (&element == vertex)
            read_ply_vertices(header, element, elements, file);
        else if (element.name == "face" && element.count > 0) {
            faces.read_polygons(element, elements);
            file.polygons = element.count;
        } else if (element.name == "tristrips")
            faces.read_strips(element, elements);
        else
            elements.skip(element);
    }
    // In binary data empty faces are what a wrong count of vertices looks like.
    const std::vector<std::uint32_t>& sizes = file.soup.polygon_sizes;
    if (header.encoding != PlyEncoding::ascii && std::count(sizes.begin(), sizes.end(), 0U) > 0)
        throw BrokenContent("holds faces of 0 vertices, expected 3 or more");
    if (elements.left_over() > 0) file.warnings.add("there is more in the file than its header says: not read");
    warn_of_textures(header, file);
    if (!file.soup.corners.empty()) file.points.reset();
    return file;
}

}  // namespace vmap
