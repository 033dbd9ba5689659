// SPDX-License-Identifier: GPL-3.0-or-later
#include "stl.h"

#include "../content_error.h"
#include "text_cursor.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>
#include <map>
#include <utility>

namespace vmap {
namespace {

using Imath::V3d;
using Imath::V3f;

static_assert(std::endian::native == std::endian::little, "binary STL is little-endian");

constexpr std::size_t header_size = 80;
constexpr std::size_t facet_size = 12 * sizeof(float) + 2;
constexpr const char* no_normal = "facet normals that are no numbers: the winding says where the front is";
constexpr std::size_t first_facet = header_size + sizeof(std::uint32_t);

std::uint32_t facet_count(std::string_view bytes) {
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + header_size, sizeof count);
    return count;
}

void finish(MeshFile& file, const std::vector<V3d>& positions) {
    file.polygons = positions.size() / 3;
    if (file.polygons == 0) throw BrokenContent("the file has 0 triangles");
    PolygonSoup& soup = file.soup;
    soup.positions = frame_positions(positions);
    soup.polygon_sizes.assign(file.polygons, 3);

    // Sorting brings equal positions together; the first of them in the file stands for all.
    const std::vector<V3f>& all = soup.positions.offsets;
    std::vector<std::uint32_t> order(all.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto key = [&](std::uint32_t i) { return std::array<float, 3>{all[i].x, all[i].y, all[i].z}; };
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return std::pair(key(a), a) < std::pair(key(b), b); });
    std::vector<std::uint32_t> first(all.size());
    for (std::size_t k = 0; k < order.size(); ++k)
        first[order[k]] = k > 0 && all[order[k]] == all[order[k - 1]] ? first[order[k - 1]] : order[k];

    std::vector<V3f> merged;
    soup.corners.resize(all.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) {
        if (first[i] == i) {
            soup.corners[i] = static_cast<std::uint32_t>(merged.size());
            merged.push_back(all[i]);
        } else {
            soup.corners[i] = soup.corners[first[i]];
        }
    }
    soup.positions.offsets = std::move(merged);
}

MeshFile read_binary(std::string_view bytes) {
    MeshFile file;
    file.format = "STL, binary";
    const std::uint32_t count = facet_count(bytes);
    std::vector<V3d> positions;
    positions.reserve(std::size_t{3} * count);
    const char* facet = bytes.data() + first_facet;
    for (std::uint32_t i = 0; i < count; ++i, facet += facet_size) {
        float values[12];
        std::memcpy(values, facet, sizeof values);
        if (!std::all_of(values, values + 3, [](float value) { return std::isfinite(value); }))
            file.warnings.add(no_normal);
        for (int corner = 1; corner <= 3; ++corner) {
            const V3d position(values[3 * corner], values[3 * corner + 1], values[3 * corner + 2]);
            for (int axis = 0; axis < 3; ++axis)
                if (!is_usable_coordinate(position[axis]))
                    throw BrokenContent(fmt::format(
                        "facet {} has the coordinate {}, expected a finite number of at most 1e18", i, position[axis]));
            positions.push_back(position);
        }
    }
    finish(file, positions);
    return file;
}

bool equals_ignoring_case(std::string_view word, std::string_view lower_case) {
    return std::equal(word.begin(), word.end(), lower_case.begin(), lower_case.end(),
                      [](unsigned char a, char b) { return static_cast<char>(std::tolower(a)) == b; });
}

class TextReader {
public:
    explicit TextReader(std::string_view text) : words_(text) {}

    MeshFile read() {
        while (!words_.at_end()) {
            expect("solid");
            words_.next_line();  // the name
            while (!equals_ignoring_case(words_.peek_word(), "endsolid")) read_facet();
            static_cast<void>(words_.word());
            words_.next_line();
        }
        file_.format = "STL, text";
        finish(file_, positions_);
        return std::move(file_);
    }

private:
    void read_facet() {
        expect("facet");
        read_normal();
        expect("outer");
        expect("loop");
        for (int corner = 0; corner < 3; ++corner) {
            expect("vertex");
            V3d position;
            for (int axis = 0; axis < 3; ++axis) position[axis] = words_.number("a coordinate of a vertex");
            positions_.push_back(position);
        }
        expect("endloop");
        expect("endfacet");
    }

    /// The winding counts, not the normal, which is often "nan nan nan".
    void read_normal() {
        static_cast<void>(words_.word_on_line());  // "normal"
        bool finite = true;
        for (std::string_view word = words_.word_on_line(); !word.empty(); word = words_.word_on_line())
            finite = finite && std::isfinite(number_from_text(word).value_or(NAN));
        if (!finite) file_.warnings.add(no_normal);
    }

    void expect(std::string_view keyword) {
        const std::string_view found = words_.word();
        if (equals_ignoring_case(found, keyword)) return;
        words_.fail(
            fmt::format("found {}, expected '{}'", found.empty() ? "the end of the file" : quoted(found), keyword));
    }

    TextCursor words_;
    MeshFile file_;
    std::vector<V3d> positions_;
};

}  // namespace

bool is_binary_stl(std::string_view start, std::uint64_t size) {
    return start.size() >= first_facet && size - first_facet == std::uint64_t{facet_count(start)} * facet_size;
}

MeshFile read_stl(std::string_view text) {
    if (is_binary_stl(text, text.size())) return read_binary(text);
    TextCursor words(text);
    if (!equals_ignoring_case(words.peek_word(), "solid")) {
        if (text.size() < first_facet)
            throw BrokenContent("neither text that starts with 'solid' nor the header of a binary STL file");
        throw BrokenContent(fmt::format("the header promises {} triangles, which is {} bytes, but the file has {}",
                                        facet_count(text), first_facet + std::uint64_t{facet_count(text)} * facet_size,
                                        text.size()));
    }
    return TextReader(text).read();
}

}  // namespace vmap
