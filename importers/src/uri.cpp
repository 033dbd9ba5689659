// SPDX-License-Identifier: GPL-3.0-or-later
#include "uri.h"

#include "content_error.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>

namespace vmap {
namespace {

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

bool has_scheme(std::string_view uri) {
    const std::size_t colon = uri.find_first_of(":/?#");
    if (colon == std::string_view::npos || uri[colon] != ':' || colon == 0) return false;
    return std::all_of(uri.begin(), uri.begin() + static_cast<std::ptrdiff_t>(colon),
                       [](unsigned char c) { return std::isalnum(c) != 0 || c == '+' || c == '-' || c == '.'; });
}

constexpr std::uint8_t not_base64 = 0xFF;

constexpr std::array<std::uint8_t, 256> make_base64_values() {
    constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::array<std::uint8_t, 256> values{};
    values.fill(not_base64);
    for (std::size_t i = 0; i < alphabet.size(); ++i)
        values[static_cast<unsigned char>(alphabet[i])] = static_cast<std::uint8_t>(i);
    return values;
}

constexpr std::array<std::uint8_t, 256> base64_values = make_base64_values();

Bytes decode_base64(std::string_view text) {
    while (!text.empty() && text.back() == '=' && text.size() % 4 != 1) text.remove_suffix(1);
    const std::size_t rest = text.size() % 4;
    if (rest == 1) throw BrokenContent("a data URI whose base64 text is cut off");

    Bytes bytes(text.size() / 4 * 3 + (rest > 0 ? rest - 1 : 0));
    std::byte* out = bytes.data();
    std::byte* const end = out + bytes.size();
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const std::uint8_t value = base64_values[static_cast<unsigned char>(text[i])];
        if (value == not_base64) throw BrokenContent("a data URI with a character that is not base64");
        bits = bits << 6U | value;
        // Every second to fourth character of a group completes a byte.
        const std::size_t place = i % 4;
        if (place > 0 && out != end) *out++ = static_cast<std::byte>(bits >> (6 - 2 * place) & 0xFFU);
    }
    return bytes;
}

bool starts_with_data_scheme(std::string_view uri) {
    constexpr std::string_view scheme = "data:";
    return uri.size() >= scheme.size() && std::equal(scheme.begin(), scheme.end(), uri.begin(), [](char a, char b) {
               return a == static_cast<char>(std::tolower(static_cast<unsigned char>(b)));
           });
}

}  // namespace

std::string path_from_uri(std::string_view uri) {
    if (has_scheme(uri)) throw BrokenContent("a URI with a scheme is not opened, expected a relative path");
    std::string path;
    path.reserve(uri.size());
    for (std::size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] != '%') {
            path += uri[i];
            continue;
        }
        const int high = i + 2 < uri.size() ? hex_digit(uri[i + 1]) : -1;
        const int low = i + 2 < uri.size() ? hex_digit(uri[i + 2]) : -1;
        if (high < 0 || low < 0) throw BrokenContent("a '%' in the URI is not followed by two hexadecimal digits");
        path += static_cast<char>(high * 16 + low);
        i += 2;
    }
    return path;
}

std::optional<Bytes> bytes_from_data_uri(std::string_view uri) {
    if (!starts_with_data_scheme(uri)) return std::nullopt;
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos) throw BrokenContent("a data URI without a comma");
    if (!uri.substr(0, comma).ends_with(";base64")) throw BrokenContent("a data URI that is not base64");
    return decode_base64(uri.substr(comma + 1));
}

}  // namespace vmap
