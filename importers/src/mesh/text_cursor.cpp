// SPDX-License-Identifier: GPL-3.0-or-later
#include "text_cursor.h"

#include "../content_error.h"

#include <vmap/printable.h>

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

namespace vmap {
namespace {

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

bool is_line_end(char c) {
    return c == '\n' || c == '\r';
}

/// from_chars knows no plus sign.
std::string_view without_plus(std::string_view text) {
    if (text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+') text.remove_prefix(1);
    return text;
}

}  // namespace

void TextCursor::skip_blanks() {
    while (position_ < text_.size() && is_blank(text_[position_])) ++position_;
    if (comment_ != 0 && position_ < text_.size() && text_[position_] == comment_)
        while (position_ < text_.size() && !is_line_end(text_[position_])) ++position_;
}

void TextCursor::skip_space() {
    skip_blanks();
    while (position_ < text_.size() && is_line_end(text_[position_])) {
        next_line();
        skip_blanks();
    }
}

std::size_t TextCursor::end_of_word() const {
    std::size_t end = position_;
    while (end < text_.size() && !is_blank(text_[end]) && !is_line_end(text_[end]) &&
           (comment_ == 0 || text_[end] != comment_))
        ++end;
    return end;
}

std::string_view TextCursor::word_on_line() {
    skip_blanks();
    const std::size_t begin = position_;
    position_ = end_of_word();
    return text_.substr(begin, position_ - begin);
}

std::string_view TextCursor::word() {
    skip_space();
    return word_on_line();
}

std::string_view TextCursor::peek_word() {
    skip_space();
    return text_.substr(position_, end_of_word() - position_);
}

std::string_view TextCursor::rest_of_line() {
    skip_blanks();
    const std::size_t begin = position_;
    std::size_t end = begin;
    for (; position_ < text_.size() && !is_line_end(text_[position_]); ++position_) {
        if (comment_ != 0 && text_[position_] == comment_) {
            skip_blanks();
            break;
        }
        if (!is_blank(text_[position_])) end = position_ + 1;
    }
    return text_.substr(begin, end - begin);
}

void TextCursor::next_line() {
    while (position_ < text_.size() && !is_line_end(text_[position_])) ++position_;
    if (position_ >= text_.size()) return;
    const bool carriage_return = text_[position_++] == '\r';
    if (carriage_return && position_ < text_.size() && text_[position_] == '\n') ++position_;
    ++line_;
}

bool TextCursor::at_end() {
    skip_space();
    return position_ >= text_.size();
}

double TextCursor::number(const char* wanted) {
    const std::string_view found = word();
    const std::optional<double> value = number_from_text(found);
    if (!value || !is_usable_coordinate(*value)) fail(fmt::format("found {}, expected {}", quoted(found), wanted));
    return *value;
}

std::int64_t TextCursor::integer(const char* wanted) {
    const std::string_view found = word();
    const std::optional<std::int64_t> value = integer_from_text(found);
    if (!value) fail(fmt::format("found {}, expected {}", quoted(found), wanted));
    return *value;
}

void TextCursor::expect_end_of_line(const char* after) {
    const std::string_view found = word_on_line();
    if (!found.empty()) fail(fmt::format("found {}, expected the end of the line after {}", quoted(found), after));
}

void TextCursor::fail(const std::string& message) const {
    throw BrokenContent(fmt::format("line {}: {}", line_, message));
}

std::optional<double> number_from_text(std::string_view text) {
    text = without_plus(text);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end != text.data() + text.size() || error == std::errc::invalid_argument) return std::nullopt;
    if (error != std::errc::result_out_of_range) return value;

    // Out of range at which end? Without an exponent only a long fraction can be too small.
    const std::size_t exponent = text.find_first_of("eE");
    const bool tiny = exponent == text.npos ? text.find_first_of("123456789") > text.find('.')
                                            : text.substr(exponent + 1).starts_with('-');
    if (tiny) return 0.0;
    return std::copysign(std::numeric_limits<double>::infinity(), text[0] == '-' ? -1.0 : 1.0);
}

std::optional<std::int64_t> integer_from_text(std::string_view text) {
    text = without_plus(text);
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end != text.data() + text.size() || error != std::errc()) return std::nullopt;
    return value;
}

bool is_usable_coordinate(double value) {
    constexpr double largest = 1e18;
    return std::abs(value) <= largest;
}

std::string quoted(std::string_view word) {
    constexpr std::size_t longest = 40;
    if (word.empty()) return "the end of the line";
    if (word.size() <= longest) return '\'' + printable(word) + '\'';
    return '\'' + printable(word.substr(0, longest)) + "...'";
}

}  // namespace vmap
