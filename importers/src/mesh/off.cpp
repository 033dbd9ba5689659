// SPDX-License-Identifier: GPL-3.0-or-later
#include "off.h"

#include "../content_error.h"
#include "colors.h"
#include "text_cursor.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace vmap {
namespace {

using Imath::C3f;
using Imath::V3d;

/// What the first word says about each vertex.
struct VertexLayout {
    bool texcoords = false;
    bool colors = false;
    bool normals = false;
};

class OffReader {
public:
    explicit OffReader(std::string_view text) : words_(text, '#') { file_.format = "OFF, text"; }

    MeshFile read() {
        const VertexLayout layout = read_magic();
        const std::size_t vertices = read_count("vertices", smallest_vertex(layout));
        const std::size_t faces = read_count("faces", 2);
        // Edges are counted in most files and used by none.
        static_cast<void>(words_.word_on_line());
        words_.expect_end_of_line("the numbers of vertices, faces and edges");
        if (vertices == 0) words_.fail("the file has 0 vertices");

        read_vertices(vertices, layout);
        file_.polygons = faces;
        for (std::size_t i = 0; i < faces; ++i) read_face(vertices);
        if (face_colors_.size() == faces)
            file_.soup.polygon_colors = std::move(face_colors_);
        else if (!face_colors_.empty())
            file_.warnings.add("only some faces have colours: not read");
        decode_text_colors(file_.soup.polygon_colors);
        if (!words_.at_end()) file_.warnings.add("there is more in the file than its first lines say: not read");
        return std::move(file_);
    }

private:
    VertexLayout read_magic() {
        VertexLayout layout;
        std::string_view magic = words_.peek_word();
        if (!magic.ends_with("OFF")) return layout;  // an old file starts with its counts
        static_cast<void>(words_.word());
        if (words_.peek_word() == "BINARY") throw UnsupportedContent("a binary OFF file: only text is read");
        magic.remove_suffix(3);
        const auto take = [&](std::string_view letters) {
            if (!magic.starts_with(letters)) return false;
            magic.remove_prefix(letters.size());
            return true;
        };
        layout.texcoords = take("ST");
        layout.colors = take("C");
        layout.normals = take("N");
        if (!magic.empty()) throw UnsupportedContent("an OFF file whose vertices have more than three coordinates");
        return layout;
    }

    static std::size_t smallest_vertex(const VertexLayout& layout) {
        return 2 * (3U + (layout.normals ? 3 : 0) + (layout.colors ? 3 : 0) + (layout.texcoords ? 2 : 0));
    }

    std::size_t read_count(const char* of, std::size_t smallest_size) {
        const std::int64_t count = words_.integer(fmt::format("the number of {}", of).c_str());
        if (count < 0) words_.fail(fmt::format("the number of {} is {}", of, count));
        if (static_cast<std::uint64_t>(count) > (words_.remaining() + 1) / smallest_size)
            words_.fail(fmt::format("the number of {} is {}, more than fit in the rest of the file", of, count));
        return static_cast<std::size_t>(count);
    }

    void read_vertices(std::size_t count, const VertexLayout& layout) {
        std::vector<V3d> positions;
        positions.reserve(count);
        PolygonSoup& soup = file_.soup;
        for (std::size_t i = 0; i < count; ++i) {
            positions.push_back(read_vector("a coordinate of a vertex"));
            if (layout.normals) soup.normals.emplace_back(read_vector("a coordinate of a normal"));
            if (layout.colors) soup.colors.push_back(read_vertex_color());
            if (layout.texcoords) {
                const double s = words_.number("a texture coordinate");
                const double t = words_.number("a texture coordinate");
                soup.texcoords.emplace_back(static_cast<float>(s), static_cast<float>(1 - t));
            }
            // Some writers add colours without saying so in the first word.
            if (!layout.colors && !layout.normals) read_surprise_color(i);
            words_.expect_end_of_line("a vertex");
        }
        if (soup.colors.size() != count) soup.colors.clear();
        decode_text_colors(soup.colors);
        soup.positions = frame_positions(positions);
    }

    V3d read_vector(const char* wanted) {
        V3d v;
        for (int axis = 0; axis < 3; ++axis) v[axis] = words_.number(wanted);
        return v;
    }

    /// As it stands in the file.
    C3f read_vertex_color() {
        const std::optional<C3f> color = read_color_on_line();
        if (!color) words_.fail("expected the three or four numbers of a colour");
        return *color;
    }

    void read_surprise_color(std::size_t vertex) {
        const std::optional<C3f> color = read_color_on_line();
        if (color && file_.soup.colors.size() == vertex) file_.soup.colors.push_back(*color);
    }

    std::optional<C3f> read_color_on_line() {
        double values[4];
        int count = 0;
        while (count < 4) {
            const std::string_view word = words_.word_on_line();
            if (word.empty()) break;
            const std::optional<double> value = number_from_text(word);
            if (!value || !is_usable_coordinate(*value)) words_.fail("found " + quoted(word) + ", expected a colour");
            values[count++] = *value;
        }
        // One number alone is a place in a palette that is not part of the file.
        if (count < 3) return std::nullopt;
        return C3f(static_cast<float>(values[0]), static_cast<float>(values[1]), static_cast<float>(values[2]));
    }

    void read_face(std::size_t vertices) {
        PolygonSoup& soup = file_.soup;
        const std::int64_t size = words_.integer("the number of vertices of a face");
        if (size < 0 || static_cast<std::uint64_t>(size) > (words_.remaining() + 1) / 2)
            words_.fail(
                fmt::format("a face with {} vertices, more than fit in the rest of the file or less than none", size));
        for (std::int64_t i = 0; i < size; ++i) {
            const std::int64_t index = words_.integer("a vertex of a face");
            if (index < 0 || static_cast<std::uint64_t>(index) >= vertices)
                words_.fail(fmt::format("a face uses vertex {}, but there are {} vertices from 0", index, vertices));
            soup.corners.push_back(static_cast<std::uint32_t>(index));
        }
        soup.polygon_sizes.push_back(static_cast<std::uint32_t>(size));
        const std::optional<C3f> color = read_color_on_line();
        if (color) face_colors_.push_back(*color);
        words_.expect_end_of_line("a face");
    }

    TextCursor words_;
    MeshFile file_;
    std::vector<C3f> face_colors_;
};

}  // namespace

MeshFile read_off(std::string_view text) {
    return OffReader(text).read();
}

}  // namespace vmap
