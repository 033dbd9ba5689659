// SPDX-License-Identifier: GPL-3.0-or-later
#include "ply_elements.h"

#include "../content_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <type_traits>

namespace vmap {
namespace {

static_assert(std::endian::native == std::endian::little, "values of big-endian files are turned around");

/// Values of a binary file.
class BinaryValues {
public:
    BinaryValues(std::string_view bytes, bool swap) : bytes_(bytes), swap_(swap) {}

    double number(const PlyProperty& property) { return convert<double>(property.type); }
    std::int64_t integer(const PlyProperty&, PlyType type) { return convert<std::int64_t>(type); }

    /// Whether so many values of a type can still follow.
    [[nodiscard]] bool holds(std::uint64_t count, PlyType type) const { return count <= bytes_.size() / size_of(type); }

    void pass_over(std::size_t size) {
        if (size > bytes_.size()) throw BrokenContent("the file ends before its last element");
        bytes_.remove_prefix(size);
    }
    void end_element() {}

    [[nodiscard]] std::string_view rest() const { return bytes_; }

private:
    template <class To>
    To convert(PlyType type) {
        switch (type) {
            case PlyType::int8:
                return static_cast<To>(take<std::int8_t>());
            case PlyType::uint8:
                return static_cast<To>(take<std::uint8_t>());
            case PlyType::int16:
                return static_cast<To>(take<std::int16_t>());
            case PlyType::uint16:
                return static_cast<To>(take<std::uint16_t>());
            case PlyType::int32:
                return static_cast<To>(take<std::int32_t>());
            case PlyType::uint32:
                return static_cast<To>(take<std::uint32_t>());
            case PlyType::float32:
                return static_cast<To>(take<float>());
            case PlyType::float64:
                return static_cast<To>(take<double>());
        }
        return {};
    }

    template <class T>
    T take() {
        char raw[sizeof(T)];
        if (bytes_.size() < sizeof raw) throw BrokenContent("the file ends before its last element");
        bytes_.copy(raw, sizeof raw);
        bytes_.remove_prefix(sizeof raw);
        if (swap_) std::reverse(std::begin(raw), std::end(raw));
        T value;
        std::memcpy(&value, raw, sizeof raw);
        return value;
    }

    std::string_view bytes_;
    bool swap_;
};

/// Values of a text file. Each element ends its line.
class TextValues {
public:
    explicit TextValues(const TextCursor& words) : words_(words) {}

    double number(const PlyProperty& property) {
        if (is_integer(property.type)) return static_cast<double>(integer(property, property.type));
        const std::string_view word = words_.word();
        const std::optional<double> value = number_from_text(word);
        if (!value) fail(property, word, "a number");
        return *value;
    }

    std::int64_t integer(const PlyProperty& property, PlyType) {
        const std::string_view word = words_.word();
        const std::optional<std::int64_t> value = integer_from_text(word);
        if (!value) fail(property, word, "a whole number");
        return *value;
    }

    /// Each value but the last takes a digit and a blank.
    [[nodiscard]] bool holds(std::uint64_t count, PlyType) const { return count <= (words_.remaining() + 1) / 2; }

    void end_element() { words_.expect_end_of_line("an element"); }

    [[nodiscard]] const TextCursor& words() const { return words_; }

private:
    [[noreturn]] void fail(const PlyProperty& property, std::string_view word, const char* expected) const {
        if (word.empty()) words_.fail("the file ends before its last element");
        words_.fail(fmt::format("{} is {}, expected {}", quoted(property.name), quoted(word), expected));
    }

    TextCursor words_;
};

/// What to do with each property of an element, in order.
struct Step {
    const PlyProperty* property = nullptr;
    const PlyColumn* column = nullptr;
    const PlyList* list = nullptr;
};

std::vector<Step> plan(const PlyElement& element, std::span<const PlyColumn> columns, std::span<const PlyList> lists) {
    std::vector<Step> steps(element.properties.size());
    for (std::size_t i = 0; i < steps.size(); ++i) steps[i].property = &element.properties[i];
    for (const PlyColumn& column : columns) steps[column.property].column = &column;
    for (const PlyList& list : lists) steps[list.property].list = &list;
    return steps;
}

void store(const PlyColumn& column, std::uint64_t row, double value) {
    std::visit(
        [&](auto* first) {
            using T = std::remove_pointer_t<decltype(first)>;
            first[row * column.stride] = static_cast<T>(value);
        },
        column.first);
}

[[noreturn]] void fail_at(const PlyElement& element, std::uint64_t row, const std::string& what) {
    throw BrokenContent(fmt::format("{} {}: {}", quoted(element.name), row, what));
}

template <class Values>
class RowReader {
public:
    RowReader(Values& values, const PlyElement& element) : values_(values), element_(element) {}

    void read(std::span<const Step> steps) {
        for (row_ = 0; row_ < element_.count; ++row_) {
            for (const Step& step : steps) {
                if (step.property->is_list())
                    read_list(step);
                else
                    read_scalar(step);
            }
            values_.end_element();
        }
    }

private:
    void read_scalar(const Step& step) {
        const double value = values_.number(*step.property);
        if (step.column == nullptr) return;
        if (std::holds_alternative<std::uint32_t*>(step.column->first) && !(value >= 0 && value <= 0xFFFFFFFFLL))
            fail_at(element_, row_,
                    fmt::format("{} is {}, expected a number from 0", quoted(step.property->name), value));
        store(*step.column, row_, value);
    }

    void read_list(const Step& step) {
        const PlyProperty& property = *step.property;
        const std::int64_t length = values_.integer(property, property.length_type.value_or(PlyType::uint8));
        if (length < 0 || !values_.holds(static_cast<std::uint64_t>(length), property.type))
            fail_at(element_, row_,
                    fmt::format("the list {} has {} values, more than the file can hold or less than none",
                                quoted(property.name), length));
        if (step.list == nullptr) {
            for (std::int64_t i = 0; i < length; ++i) static_cast<void>(values_.number(property));
            return;
        }
        list_.clear();
        for (std::int64_t i = 0; i < length; ++i) list_.push_back(values_.integer(property, property.type));
        step.list->take(list_);
    }

    Values& values_;
    const PlyElement& element_;
    std::uint64_t row_ = 0;
    std::vector<std::int64_t> list_;
};

/// Fewest bytes of one element.
std::size_t smallest_size(const PlyElement& element, PlyEncoding encoding) {
    std::size_t size = 0;
    for (const PlyProperty& property : element.properties)
        size += encoding == PlyEncoding::ascii ? 2 : size_of(property.length_type.value_or(property.type));
    return size;
}

bool has_lists(const PlyElement& element) {
    return std::any_of(element.properties.begin(), element.properties.end(),
                       [](const PlyProperty& property) { return property.is_list(); });
}

}  // namespace

PlyElements::PlyElements(const PlyHeader& header, std::string_view text)
    : encoding_(header.encoding),
      words_(text.substr(header.size), 0, header.lines + 1),
      bytes_(text.substr(header.size)) {}

void PlyElements::expect_to_fit(const PlyElement& element) const {
    const std::size_t size = smallest_size(element, encoding_);
    if (size == 0) return;
    const std::size_t left = encoding_ == PlyEncoding::ascii ? words_.remaining() + 1 : bytes_.size();
    if (element.count > left / size)
        throw BrokenContent(
            fmt::format("the header promises {} elements {}, but {} bytes are left for them, fewer than {} each",
                        element.count, quoted(element.name), left, size));
}

void PlyElements::read(const PlyElement& element, std::span<const PlyColumn> columns, std::span<const PlyList> lists) {
    expect_to_fit(element);
    if (element.properties.empty()) return;
    const std::vector<Step> steps = plan(element, columns, lists);
    if (encoding_ == PlyEncoding::ascii) {
        TextValues values(words_);
        RowReader(values, element).read(steps);
        words_ = values.words();
        return;
    }
    BinaryValues values(bytes_, encoding_ == PlyEncoding::big_endian);
    if (columns.empty() && !has_lists(element))
        values.pass_over(smallest_size(element, encoding_) * element.count);
    else
        RowReader(values, element).read(steps);
    bytes_ = values.rest();
}

std::size_t PlyElements::left_over() {
    if (encoding_ != PlyEncoding::ascii) return bytes_.size();
    return words_.at_end() ? 0 : words_.remaining();
}

}  // namespace vmap
