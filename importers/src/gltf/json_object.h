// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Reading a JSON document that is not trusted: every value is checked for its type and range when it is read, and a
/// wrong one is told with its place in the document.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vmap::gltf {

/// Limits of a number. The default takes any finite one.
struct Range {
    double least = -std::numeric_limits<double>::max();
    double most = std::numeric_limits<double>::max();
};

inline constexpr Range not_negative{0, std::numeric_limits<double>::max()};
inline constexpr Range unit_interval{0, 1};
inline constexpr Range above_zero{std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::max()};

/// A view of one object of a document. The readers return nothing for a missing key and throw BrokenContent for a value
/// of the wrong type or out of range.
class JsonObject {
public:
    /// - where: the object's place in the document, for messages
    JsonObject(const nlohmann::json& value, std::string where);

    [[nodiscard]] const std::string& where() const { return where_; }
    [[nodiscard]] bool has(const char* key) const;

    [[nodiscard]] std::optional<std::uint64_t> integer(const char* key, std::uint64_t least, std::uint64_t most) const;
    [[nodiscard]] std::optional<double> number(const char* key, Range range = {}) const;
    [[nodiscard]] std::optional<bool> boolean(const char* key) const;
    [[nodiscard]] std::optional<std::string> text(const char* key) const;

    /// The index of an element of an array of that many.
    [[nodiscard]] std::optional<std::size_t> index(const char* key, std::size_t count) const;
    /// An array of such indices.
    [[nodiscard]] std::vector<std::size_t> indices(const char* key, std::size_t count) const;

    /// Fills an array of exactly this many numbers; false when the key is missing.
    bool numbers(const char* key, std::span<double> out, Range range = {}) const;
    /// An array of any number of them.
    [[nodiscard]] std::vector<double> numbers(const char* key) const;
    [[nodiscard]] std::vector<std::string> texts(const char* key) const;

    [[nodiscard]] std::optional<JsonObject> object(const char* key) const;
    /// The object of an extension of this object.
    [[nodiscard]] std::optional<JsonObject> extension(const char* name) const;

    /// A number in this object's extras, where anything may stand: nothing unless it is a finite number.
    [[nodiscard]] std::optional<double> extra_number(const char* key) const;
    /// An index there: nothing unless it is one of an array of that many.
    [[nodiscard]] std::optional<std::size_t> extra_index(const char* key, std::size_t count) const;
    /// A text there: nothing unless it is one.
    [[nodiscard]] std::optional<std::string> extra_text(const char* key) const;

    /// Number of elements of an array; 0 when the key is missing. The specification wants no empty arrays, but writers
    /// leave them.
    [[nodiscard]] std::size_t array_size(const char* key) const;
    /// Calls a function with each object of an array and its index.
    void for_each(const char* key, const std::function<void(const JsonObject&, std::size_t)>& function) const;
    /// Calls a function with each key of this object whose value is the index of an element of an array of that many.
    void for_each_index(std::size_t count, const std::function<void(const std::string&, std::size_t)>& function) const;

    /// Values that have to be there.
    template <class T>
    [[nodiscard]] T required(std::optional<T> value, const char* key) const {
        if (!value) fail_missing(key);
        return *value;
    }
    [[noreturn]] void fail_missing(const char* key) const;
    /// Throws BrokenContent: "materials[3].alphaMode is ..., expected ...".
    [[noreturn]] void fail(const char* key, const std::string& expected) const;

private:
    [[nodiscard]] std::string place(const std::string& key) const;
    [[nodiscard]] const nlohmann::json* find(const char* key) const;
    [[nodiscard]] const nlohmann::json* find_array(const char* key) const;
    [[nodiscard]] const nlohmann::json* find_extra(const char* key) const;
    [[noreturn]] static void fail_value(const std::string& where, const nlohmann::json& value,
                                        const std::string& expected);

    const nlohmann::json* value_;
    std::string where_;
};

/// A parsed document.
class JsonDocument {
public:
    /// - throws BrokenContent when the text is not JSON with an object at its root, or nests deeper than any sound file
    explicit JsonDocument(std::string_view text);
    ~JsonDocument();
    JsonDocument(const JsonDocument&) = delete;
    JsonDocument& operator=(const JsonDocument&) = delete;

    [[nodiscard]] JsonObject root() const;

private:
    std::unique_ptr<nlohmann::json> value_;
};

}  // namespace vmap::gltf
