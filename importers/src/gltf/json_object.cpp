// SPDX-License-Identifier: GPL-3.0-or-later
#include "json_object.h"

#include "../content_error.h"
#include "limits.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <utility>

namespace vmap::gltf {
namespace {

using nlohmann::json;

constexpr double largest_exact_integer = 9007199254740992.0;  // 2^53: above it JSON numbers are not exact

/// A value in a message: short, and never a whole sub-tree.
std::string describe(const json& value) {
    constexpr std::size_t longest = 40;
    if (value.is_object()) return "an object";
    if (value.is_array()) return fmt::format("an array of {}", value.size());
    if (value.is_string()) {
        const auto& text = value.get_ref<const std::string&>();
        return "'" + (text.size() > longest ? text.substr(0, longest) + "..." : text) + "'";
    }
    return value.dump();
}

/// JSON has one kind of number: 3.0 is an integer too.
std::optional<std::uint64_t> as_integer(const json& value) {
    if (value.is_number_unsigned()) return value.get<std::uint64_t>();
    if (!value.is_number_float()) return std::nullopt;
    const double number = value.get<double>();
    if (number < 0 || number > largest_exact_integer || number != std::floor(number)) return std::nullopt;
    return static_cast<std::uint64_t>(number);
}

std::optional<double> as_number(const json& value, Range range) {
    if (!value.is_number()) return std::nullopt;
    const double number = value.get<double>();
    if (!(number >= range.least && number <= range.most)) return std::nullopt;
    return number;
}

std::string expected_number(Range range) {
    const bool bounded_below = range.least > -std::numeric_limits<double>::max();
    const bool bounded_above = range.most < std::numeric_limits<double>::max();
    if (bounded_below && bounded_above) return fmt::format("a number from {} to {}", range.least, range.most);
    if (range.least == above_zero.least) return "a number above 0";
    if (bounded_below) return fmt::format("a number from {}", range.least);
    return "a number";
}

/// Refuses deep nesting before the parser and everything behind it meets it.
void check_nesting(std::string_view text) {
    int depth = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_string) {
            if (c == '\\')
                ++i;
            else if (c == '"')
                in_string = false;
        } else if (c == '"') {
            in_string = true;
        } else if (c == '{' || c == '[') {
            if (++depth > deepest_nesting)
                throw BrokenContent(fmt::format("the JSON text nests deeper than {} levels", deepest_nesting));
        } else if (c == '}' || c == ']') {
            --depth;
        }
    }
}

json parse(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) throw BrokenContent("the JSON text starts with a byte order mark");
    check_nesting(text);
    try {
        return json::parse(text);
    } catch (const json::parse_error& error) {
        throw BrokenContent(fmt::format("the text is not JSON: syntax error at byte {}", error.byte));
    } catch (const json::out_of_range&) {
        throw BrokenContent("the JSON text holds a number that is too large");
    }
}

}  // namespace

JsonObject::JsonObject(const json& value, std::string where) : value_(&value), where_(std::move(where)) {
    if (!value.is_object()) fail_value(where_, value, "an object");
}

std::string JsonObject::place(const std::string& key) const {
    return where_.empty() ? key : where_ + "." + key;
}

void JsonObject::fail_value(const std::string& where, const json& value, const std::string& expected) {
    throw BrokenContent(fmt::format("{} is {}, expected {}", where, describe(value), expected));
}

void JsonObject::fail(const char* key, const std::string& expected) const {
    const json* value = find(key);
    if (value == nullptr) fail_missing(key);
    fail_value(place(key), *value, expected);
}

void JsonObject::fail_missing(const char* key) const {
    throw BrokenContent(place(key) + " is missing");
}

const json* JsonObject::find(const char* key) const {
    const auto found = value_->find(key);
    return found == value_->end() ? nullptr : &*found;
}

const json* JsonObject::find_array(const char* key) const {
    const json* value = find(key);
    if (value != nullptr && !value->is_array()) fail(key, "an array");
    return value;
}

bool JsonObject::has(const char* key) const {
    return find(key) != nullptr;
}

std::optional<std::uint64_t> JsonObject::integer(const char* key, std::uint64_t least, std::uint64_t most) const {
    const json* value = find(key);
    if (value == nullptr) return std::nullopt;
    const std::optional<std::uint64_t> integer = as_integer(*value);
    if (!integer || *integer < least || *integer > most)
        fail(key, fmt::format("an integer from {} to {}", least, most));
    return integer;
}

std::optional<double> JsonObject::number(const char* key, Range range) const {
    const json* value = find(key);
    if (value == nullptr) return std::nullopt;
    const std::optional<double> number = as_number(*value, range);
    if (!number) fail(key, expected_number(range));
    return number;
}

std::optional<bool> JsonObject::boolean(const char* key) const {
    const json* value = find(key);
    if (value == nullptr) return std::nullopt;
    if (!value->is_boolean()) fail(key, "true or false");
    return value->get<bool>();
}

std::optional<std::string> JsonObject::text(const char* key) const {
    const json* value = find(key);
    if (value == nullptr) return std::nullopt;
    if (!value->is_string()) fail(key, "a text");
    return value->get<std::string>();
}

std::optional<std::size_t> JsonObject::index(const char* key, std::size_t count) const {
    const json* value = find(key);
    if (value == nullptr) return std::nullopt;
    const std::optional<std::uint64_t> index = as_integer(*value);
    if (!index || *index >= count) fail(key, fmt::format("an index below {}", count));
    return index;
}

std::vector<std::size_t> JsonObject::indices(const char* key, std::size_t count) const {
    std::vector<std::size_t> indices;
    const json* array = find_array(key);
    if (array == nullptr) return indices;
    indices.reserve(array->size());
    for (const json& value : *array) {
        const std::optional<std::uint64_t> index = as_integer(value);
        if (!index || *index >= count)
            fail_value(fmt::format("{}[{}]", place(key), indices.size()), value,
                       fmt::format("an index below {}", count));
        indices.push_back(*index);
    }
    return indices;
}

bool JsonObject::numbers(const char* key, std::span<double> out, Range range) const {
    const json* array = find(key);
    if (array == nullptr) return false;
    if (!array->is_array() || array->size() != out.size()) fail(key, fmt::format("an array of {} numbers", out.size()));
    for (std::size_t i = 0; i < out.size(); ++i) {
        const std::optional<double> number = as_number((*array)[i], range);
        if (!number) fail_value(fmt::format("{}[{}]", place(key), i), (*array)[i], expected_number(range));
        out[i] = *number;
    }
    return true;
}

std::vector<double> JsonObject::numbers(const char* key) const {
    const json* array = find_array(key);
    std::vector<double> out(array == nullptr ? 0 : array->size());
    if (!out.empty()) numbers(key, out);
    return out;
}

std::vector<std::string> JsonObject::texts(const char* key) const {
    std::vector<std::string> texts;
    const json* array = find_array(key);
    if (array == nullptr) return texts;
    for (const json& value : *array) {
        if (!value.is_string()) fail_value(fmt::format("{}[{}]", place(key), texts.size()), value, "a text");
        texts.push_back(value.get<std::string>());
    }
    return texts;
}

std::optional<JsonObject> JsonObject::object(const char* key) const {
    const json* value = find(key);
    if (value == nullptr) return std::nullopt;
    return JsonObject(*value, place(key));
}

std::optional<JsonObject> JsonObject::extension(const char* name) const {
    const std::optional<JsonObject> extensions = object("extensions");
    return extensions ? extensions->object(name) : std::nullopt;
}

const json* JsonObject::find_extra(const char* key) const {
    const json* extras = find("extras");
    if (extras == nullptr || !extras->is_object()) return nullptr;
    const auto found = extras->find(key);
    return found == extras->end() ? nullptr : &*found;
}

std::optional<double> JsonObject::extra_number(const char* key) const {
    const json* value = find_extra(key);
    return value == nullptr ? std::nullopt : as_number(*value, {});
}

std::optional<std::size_t> JsonObject::extra_index(const char* key, std::size_t count) const {
    const json* value = find_extra(key);
    const std::optional<std::uint64_t> index = value == nullptr ? std::nullopt : as_integer(*value);
    return index && *index < count ? index : std::nullopt;
}

std::optional<std::string> JsonObject::extra_text(const char* key) const {
    const json* value = find_extra(key);
    if (value == nullptr || !value->is_string()) return std::nullopt;
    return value->get<std::string>();
}

std::size_t JsonObject::array_size(const char* key) const {
    const json* array = find_array(key);
    return array == nullptr ? 0 : array->size();
}

void JsonObject::for_each(const char* key, const std::function<void(const JsonObject&, std::size_t)>& function) const {
    const json* array = find_array(key);
    if (array == nullptr) return;
    for (std::size_t i = 0; i < array->size(); ++i)
        function(JsonObject((*array)[i], fmt::format("{}[{}]", place(key), i)), i);
}

void JsonObject::for_each_index(std::size_t count,
                                const std::function<void(const std::string&, std::size_t)>& function) const {
    for (const auto& item : value_->items()) {
        const std::optional<std::uint64_t> index = as_integer(item.value());
        if (!index || *index >= count)
            fail_value(place(item.key()), item.value(), fmt::format("an index below {}", count));
        function(item.key(), *index);
    }
}

JsonDocument::JsonDocument(std::string_view text) : value_(std::make_unique<json>(parse(text))) {
    if (!value_->is_object()) throw BrokenContent("the JSON text is not an object");
}

JsonDocument::~JsonDocument() = default;

JsonObject JsonDocument::root() const {
    return {*value_, ""};
}

}  // namespace vmap::gltf
