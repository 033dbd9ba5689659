// SPDX-License-Identifier: GPL-3.0-or-later
#include "ply_header.h"

#include "../content_error.h"
#include "text_cursor.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

namespace vmap {
namespace {

constexpr std::size_t longest_header = std::size_t{8} << 20U;

struct TypeName {
    std::string_view name;
    PlyType type;
};

constexpr TypeName type_names[] = {
    {"char", PlyType::int8},       {"int8", PlyType::int8},       {"uchar", PlyType::uint8},
    {"uint8", PlyType::uint8},     {"short", PlyType::int16},     {"int16", PlyType::int16},
    {"ushort", PlyType::uint16},   {"uint16", PlyType::uint16},   {"int", PlyType::int32},
    {"int32", PlyType::int32},     {"uint", PlyType::uint32},     {"uint32", PlyType::uint32},
    {"float", PlyType::float32},   {"float32", PlyType::float32}, {"double", PlyType::float64},
    {"float64", PlyType::float64},
};

/// Takes the lines of a header one by one.
class HeaderReader {
public:
    explicit HeaderReader(std::string_view text) : text_(text), cursor_(text.substr(0, longest_header)) {}

    PlyHeader read() {
        if (cursor_.word_on_line() != "ply") cursor_.fail("not a PLY file: the first line is not 'ply'");
        cursor_.expect_end_of_line("'ply'");
        for (;;) {
            next_line();
            const std::string_view keyword = cursor_.word_on_line();
            if (keyword == "end_header") break;
            read_line(keyword);
        }
        cursor_.expect_end_of_line("'end_header'");
        if (!has_format_) cursor_.fail("the header has no 'format' line");
        end_header();
        return std::move(header_);
    }

private:
    void next_line() {
        cursor_.next_line();
        if (cursor_.remaining() > 0) return;
        cursor_.fail(text_.size() > longest_header ? "the header does not end within 8 MiB"
                                                   : "the file ends before 'end_header'");
    }

    void read_line(std::string_view keyword) {
        if (keyword == "comment")
            header_.comments.emplace_back(cursor_.rest_of_line());
        else if (keyword == "format")
            read_format();
        else if (keyword == "element")
            read_element();
        else if (keyword == "property")
            read_property();
        else if (keyword != "obj_info" && !keyword.empty())
            cursor_.fail("found " + quoted(keyword) + ", expected a keyword of a PLY header");
    }

    void read_format() {
        const std::string_view name = cursor_.word_on_line();
        if (name == "ascii")
            header_.encoding = PlyEncoding::ascii;
        else if (name == "binary_little_endian")
            header_.encoding = PlyEncoding::little_endian;
        else if (name == "binary_big_endian")
            header_.encoding = PlyEncoding::big_endian;
        else
            cursor_.fail("format " + quoted(name) + ", expected ascii, binary_little_endian or binary_big_endian");
        const std::string_view version = cursor_.word_on_line();
        if (version != "1.0") cursor_.fail("format version " + quoted(version) + ", expected 1.0");
        cursor_.expect_end_of_line("the format");
        if (std::exchange(has_format_, true)) cursor_.fail("a second 'format' line");
    }

    void read_element() {
        PlyElement element;
        element.name = cursor_.word_on_line();
        if (element.name.empty()) cursor_.fail("an element without a name");
        const std::string_view text = cursor_.word_on_line();
        const std::optional<std::int64_t> count = integer_from_text(text);
        if (!count || *count < 0)
            cursor_.fail(fmt::format("the number of elements {} is {}, expected a whole number from 0",
                                     quoted(element.name), quoted(text)));
        element.count = static_cast<std::uint64_t>(*count);
        cursor_.expect_end_of_line("the number of elements");
        if (!element_names_.insert(element.name).second) cursor_.fail("a second element " + quoted(element.name));
        header_.elements.push_back(std::move(element));
        property_names_.clear();
    }

    void read_property() {
        if (header_.elements.empty()) cursor_.fail("a property before the first element");
        PlyProperty property;
        std::string_view type = cursor_.word_on_line();
        if (type == "list") {
            property.length_type = type_from_name(cursor_.word_on_line());
            if (!is_integer(*property.length_type)) cursor_.fail("a list whose length is not of an integer type");
            type = cursor_.word_on_line();
        }
        property.type = type_from_name(type);
        property.name = cursor_.word_on_line();
        if (property.name.empty()) cursor_.fail("a property without a name");
        cursor_.expect_end_of_line("the property's name");
        if (!property_names_.insert(property.name).second) cursor_.fail("a second property " + quoted(property.name));
        header_.elements.back().properties.push_back(std::move(property));
    }

    [[nodiscard]] PlyType type_from_name(std::string_view name) const {
        const auto* known = std::find_if(std::begin(type_names), std::end(type_names),
                                         [&](const TypeName& entry) { return entry.name == name; });
        if (known == std::end(type_names))
            cursor_.fail("type " + quoted(name) + ", expected one of PLY such as uchar, int or float");
        return known->type;
    }

    /// The line of end_header ends as the first line did: after a lone CR a binary element may start with the byte of
    /// LF.
    void end_header() {
        std::size_t position = std::min(text_.size(), longest_header) - cursor_.remaining();
        const auto take = [&](char c) {
            if (position >= text_.size() || text_[position] != c) return false;
            ++position;
            return true;
        };
        const std::size_t first_end = text_.find_first_of("\r\n");
        const bool only_returns = text_[first_end] == '\r' && text_.substr(first_end + 1, 1) != "\n";
        const bool returned = take('\r');
        if (!(returned && only_returns) && !take('\n') && !returned && position < text_.size())
            cursor_.fail("no end of line after 'end_header'");
        header_.size = position;
        header_.lines = cursor_.line();
    }

    std::string_view text_;
    TextCursor cursor_;
    PlyHeader header_;
    bool has_format_ = false;
    std::set<std::string, std::less<>> element_names_;
    std::set<std::string, std::less<>> property_names_;
};

}  // namespace

std::size_t size_of(PlyType type) {
    switch (type) {
        case PlyType::int8:
        case PlyType::uint8:
            return 1;
        case PlyType::int16:
        case PlyType::uint16:
            return 2;
        case PlyType::float64:
            return 8;
        default:
            return 4;
    }
}

bool is_integer(PlyType type) {
    return type != PlyType::float32 && type != PlyType::float64;
}

std::optional<std::size_t> PlyElement::find(std::string_view property) const {
    const auto found = std::find_if(properties.begin(), properties.end(),
                                    [&](const PlyProperty& candidate) { return candidate.name == property; });
    if (found == properties.end()) return std::nullopt;
    return static_cast<std::size_t>(found - properties.begin());
}

const PlyElement* PlyHeader::find(std::string_view element) const {
    const auto found = std::find_if(elements.begin(), elements.end(),
                                    [&](const PlyElement& candidate) { return candidate.name == element; });
    return found == elements.end() ? nullptr : &*found;
}

PlyHeader read_ply_header(std::string_view text) {
    return HeaderReader(text).read();
}

}  // namespace vmap
