// SPDX-License-Identifier: GPL-3.0-or-later
// Geometry is read here and not by tinyobjloader, which takes 0 and far too large indices, coordinates that are no
// numbers, and faces of more than 255 corners for something else than they are. It reads the material libraries.
#include "obj.h"

#include "../content_error.h"
#include "colors.h"
#include "obj_materials.h"
#include "text_cursor.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

namespace vmap {
namespace {

using Imath::C3f;
using Imath::V2f;
using Imath::V3d;
using Imath::V3f;

/// One of the three index lists of a face's corners.
struct CornerIndices {
    std::vector<std::uint32_t> indices;
    bool any = false;           ///< some corner has one
    std::uint32_t largest = 0;  ///< and its line, to tell of one that never comes
    std::size_t largest_line = 0;
};

class ObjReader {
public:
    ObjReader(std::string_view text, const SceneFolder& folder) : words_(text, '#'), materials_(folder) {
        file_.format = "OBJ, text";
        file_.up = UpAxis::y;
    }

    MeshFile read() {
        for (; !words_.at_end(); words_.next_line()) read_statement();
        if (positions_.empty()) throw BrokenContent("the file holds no vertices");
        check_largest(corners_, positions_.size(), "vertex");
        leave_out_if_absent(texcoords_, file_.soup.texcoords.size(), "texture coordinates");
        leave_out_if_absent(normals_, file_.soup.normals.size(), "normals");
        check_largest(texcoords_, file_.soup.texcoords.size(), "texture coordinate");
        check_largest(normals_, file_.soup.normals.size(), "normal");
        finish();
        return std::move(file_);
    }

private:
    void read_statement() {
        const std::string_view keyword = words_.word_on_line();
        if (keyword == "v")
            read_vertex();
        else if (keyword == "vn")
            file_.soup.normals.emplace_back(read_numbers<3>("a normal"));
        else if (keyword == "vt")
            read_texcoord();
        else if (keyword == "f" || keyword == "fo")
            read_face();
        else if (keyword == "usemtl")
            material_ = materials_.use(words_.rest_of_line());
        else if (keyword == "mtllib")
            materials_.load(words_.rest_of_line(), file_.warnings);
        else if (keyword == "l" || keyword == "p")
            pass_over("lines and points between surfaces are not read");
        else if (is_free_form(keyword))
            pass_over("curves and free-form surfaces are not read, only polygons");
        else
            pass_over_known(keyword);
    }

    void pass_over(const char* what) {
        file_.warnings.add(what);
        skip_statement();
    }

    /// Names, groups, smoothing and display attributes.
    void pass_over_known(std::string_view keyword) {
        static constexpr std::string_view known[] = {
            "o",        "g",      "s",  "mg",     "vp",  "bevel", "lod",        "call",      "csh",   "c_interp",
            "d_interp", "maplib", "vw", "usemap", "tag", "t",     "shadow_obj", "trace_obj", "ctech", "stech"};
        if (std::find(std::begin(known), std::end(known), keyword) == std::end(known))
            file_.warnings.add("unknown statements are passed over", quoted(keyword));
        skip_statement();
    }

    static bool is_free_form(std::string_view keyword) {
        static constexpr std::string_view words[] = {"cstype", "deg",  "bmat", "step", "curv", "curv2", "surf",
                                                     "parm",   "trim", "hole", "scrv", "sp",   "end",   "con"};
        return std::find(std::begin(words), std::end(words), keyword) != std::end(words);
    }

    /// The next word of the statement; a backslash at the end of a line continues it on the next one.
    std::string_view next_word() {
        std::string_view word = words_.word_on_line();
        while (word == "\\" && words_.rest_of_line().empty()) {
            words_.next_line();
            word = words_.word_on_line();
        }
        // A backslash stuck to the word: it stays, so that the next call finds it at the end of the line.
        if (word.size() > 1 && word.back() == '\\' && words_.rest_of_line().empty()) {
            words_.next_line();
            word.remove_suffix(1);
        }
        return word;
    }

    void skip_statement() {
        while (!next_word().empty()) {
        }
    }

    double number(std::string_view word, const char* of) const {
        const std::optional<double> value = number_from_text(word);
        if (!value || !is_usable_coordinate(*value))
            words_.fail(fmt::format("found {} in {}, expected a finite number of at most 1e18", quoted(word), of));
        return *value;
    }

    template <int count>
    V3d read_numbers(const char* of) {
        V3d v(0, 0, 0);
        for (int k = 0; k < count; ++k) v[k] = number(next_word(), of);
        return v;
    }

    /// x y z, then w or r g b or both; w weighs rational curves only.
    void read_vertex() {
        positions_.push_back(read_numbers<3>("a vertex"));
        std::array<double, 4> extra{};
        std::size_t count = 0;
        for (std::string_view word = next_word(); !word.empty(); word = next_word()) {
            const double value = number(word, "a vertex");
            if (count < extra.size()) extra[count] = value;
            ++count;
        }
        if (count < 3) return;
        const std::size_t first = count == 4 && extra[0] == 1 && colors_.empty() ? 1 : 0;
        if (colors_.size() + 1 == positions_.size())
            colors_.emplace_back(V3f(V3d(extra[first], extra[first + 1], extra[first + 2])));
    }

    void read_texcoord() {
        const double u = number(next_word(), "a texture coordinate");
        const std::string_view second = next_word();
        const double v = second.empty() ? 0 : number(second, "a texture coordinate");
        skip_statement();
        file_.soup.texcoords.emplace_back(static_cast<float>(u), static_cast<float>(1 - v));
    }

    void read_face() {
        std::uint32_t size = 0;
        for (std::string_view word = next_word(); !word.empty(); word = next_word(), ++size) read_corner(word);
        file_.soup.polygon_sizes.push_back(size);
        file_.soup.polygon_materials.push_back(material_);
    }

    /// v, v/vt, v//vn or v/vt/vn.
    void read_corner(std::string_view word) {
        std::array<std::string_view, 3> parts;
        std::string_view rest = word;
        for (std::size_t k = 0; k < parts.size(); ++k) {
            const std::size_t slash = rest.find('/');
            parts[k] = rest.substr(0, slash);
            rest = slash == rest.npos ? std::string_view() : rest.substr(slash + 1);
        }
        if (!rest.empty() || parts[0].empty()) words_.fail("found " + quoted(word) + ", expected a corner of a face");
        add_index(parts[0], positions_.size(), corners_);
        add_index(parts[1], file_.soup.texcoords.size(), texcoords_);
        add_index(parts[2], file_.soup.normals.size(), normals_);
    }

    /// Counts from 1, or from -1 backwards from the newest; up to the end of the file the count may still grow.
    void add_index(std::string_view text, std::size_t count, CornerIndices& to) {
        if (text.empty()) {
            to.indices.push_back(no_index);
            return;
        }
        const std::optional<std::int64_t> number = integer_from_text(text);
        if (!number || *number == 0 || *number >= static_cast<std::int64_t>(no_index))
            words_.fail("found index " + quoted(text) +
                        ", expected a whole number from 1, or below 0 to count backwards");
        const std::int64_t index = *number > 0 ? *number - 1 : static_cast<std::int64_t>(count) + *number;
        if (index < 0) words_.fail(fmt::format("index {} counts back beyond the first of {}", *number, count));
        to.indices.push_back(static_cast<std::uint32_t>(index));
        if (!to.any || to.indices.back() > to.largest) {
            to.largest = to.indices.back();
            to.largest_line = words_.line();
        }
        to.any = true;
    }

    /// Some programs write the indices of normals and leave the normals out.
    void leave_out_if_absent(CornerIndices& indices, std::size_t count, const char* of) {
        if (!indices.any || count > 0) return;
        file_.warnings.add(fmt::format("faces use {}, but the file has none", of));
        indices = {};
    }

    static void check_largest(const CornerIndices& indices, std::size_t count, const char* of) {
        if (!indices.any || indices.largest < count) return;
        throw BrokenContent(fmt::format("line {}: a face uses {} {}, but the file has {}", indices.largest_line, of,
                                        std::size_t{indices.largest} + 1, count));
    }

    void finish() {
        PolygonSoup& soup = file_.soup;
        file_.polygons = soup.polygon_sizes.size();
        soup.positions = frame_positions(positions_);
        soup.corners = std::move(corners_.indices);
        if (texcoords_.any)
            soup.corner_texcoords = std::move(texcoords_.indices);
        else
            soup.texcoords.clear();
        if (normals_.any) soup.corner_normals = std::move(normals_.indices);
        // Without faces normals belong to the vertices, if there are as many.
        else if (!soup.corners.empty() || soup.normals.size() != positions_.size())
            soup.normals.clear();
        if (colors_.size() == positions_.size()) {
            soup.colors = std::move(colors_);
            decode_text_colors(soup.colors);
        } else if (!colors_.empty()) {
            file_.warnings.add("only some vertices have colours: not read");
        }
        materials_.finish(file_);
    }

    TextCursor words_;
    MeshFile file_;
    ObjMaterials materials_;
    std::uint32_t material_ = 0;
    std::vector<V3d> positions_;
    std::vector<C3f> colors_;
    CornerIndices corners_;
    CornerIndices texcoords_;
    CornerIndices normals_;
};

}  // namespace

MeshFile read_obj(std::string_view text, const SceneFolder& folder) {
    return ObjReader(text, folder).read();
}

}  // namespace vmap
