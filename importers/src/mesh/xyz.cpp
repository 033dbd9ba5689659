// SPDX-License-Identifier: GPL-3.0-or-later
#include "xyz.h"

#include "../content_error.h"
#include "colors.h"
#include "text_cursor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace vmap {
namespace {

using Imath::V3d;
using Imath::V3f;

/// Three columns that may be a normal or a colour.
struct Triple {
    std::vector<V3f> values;
    bool unit = true;      ///< all have length one
    bool bytes = true;     ///< all numbers are whole, from 0 to 255
    bool fraction = true;  ///< all numbers are from 0 to 1

    void add(const V3d& value, bool whole) {
        constexpr double tolerance = 0.01;
        unit = unit && std::abs(value.length() - 1) < tolerance;
        const double least = std::min({value.x, value.y, value.z});
        const double most = std::max({value.x, value.y, value.z});
        bytes = bytes && whole && least >= 0 && most <= 255;
        fraction = fraction && least >= 0 && most <= 1;
        values.emplace_back(value);
    }
};

class XyzReader {
public:
    explicit XyzReader(std::string_view text) : words_(text, '#') {}

    MeshFile read() {
        for (; !words_.at_end(); words_.next_line()) read_line();
        if (positions_.empty()) throw BrokenContent("the file holds no points");
        if (announced_ && *announced_ != static_cast<std::int64_t>(positions_.size()))
            throw BrokenContent(
                fmt::format("the file promises {} points and holds {}", *announced_, positions_.size()));
        MeshFile file;
        file.format = "XYZ, text";
        file.soup.positions = frame_positions(positions_);
        for (Triple& triple : triples_) interpret(triple, file);
        if (has_single_) file.warnings.add("the fourth column, such as an intensity, is not read");
        return file;
    }

private:
    void read_line() {
        static constexpr std::size_t most_columns = 10;
        double values[most_columns] = {};
        bool whole[most_columns] = {};
        std::size_t count = 0;
        for (std::string_view word = words_.word_on_line(); !word.empty(); word = words_.word_on_line()) {
            if (count == most_columns) words_.fail("more than 10 columns");
            const std::optional<double> value = number_from_text(word);
            if (!value || !is_usable_coordinate(*value))
                words_.fail("found " + quoted(word) + ", expected a finite number");
            whole[count] = integer_from_text(word).has_value();
            values[count++] = *value;
        }
        if (count == 1 && positions_.empty() && !announced_ && whole[0] && values[0] >= 0) {
            announced_ = static_cast<std::int64_t>(values[0]);
            return;
        }
        if (columns_ == 0) set_columns(count);
        if (count != columns_) words_.fail(fmt::format("{} columns, expected {} as before", count, columns_));
        positions_.emplace_back(values[0], values[1], values[2]);
        const std::size_t first = has_single_ ? 4 : 3;
        for (std::size_t k = 0; k < triples_.size(); ++k) {
            const std::size_t at = first + 3 * k;
            triples_[k].add({values[at], values[at + 1], values[at + 2]}, whole[at] && whole[at + 1] && whole[at + 2]);
        }
    }

    void set_columns(std::size_t count) {
        const std::size_t extra = count >= 3 ? (count - 3) % 3 : 2;
        if (extra == 2) words_.fail(fmt::format("{} columns, expected 3, 6 or 9, or one more", count));
        columns_ = count;
        has_single_ = extra == 1;
        triples_.resize((count - 3) / 3);
    }

    void interpret(Triple& triple, MeshFile& file) {
        PolygonSoup& soup = file.soup;
        if (triple.unit && soup.normals.empty()) {
            soup.normals = std::move(triple.values);
        } else if ((triple.bytes || triple.fraction) && soup.colors.empty()) {
            soup.colors.assign(triple.values.begin(), triple.values.end());
            decode_text_colors(soup.colors);
        } else {
            file.warnings.add(
                "three columns that are neither normals of length one nor colours up to 255 or 1 are not read");
        }
    }

    TextCursor words_;
    std::vector<V3d> positions_;
    std::vector<Triple> triples_;
    std::size_t columns_ = 0;
    bool has_single_ = false;
    std::optional<std::int64_t> announced_;
};

}  // namespace

MeshFile read_xyz(std::string_view text) {
    return XyzReader(text).read();
}

}  // namespace vmap
