// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Walks through the text of a file word by word and knows in which line it is.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace vmap {

/// Lines end with LF, CRLF or CR. The text must outlive the cursor and the words it gives out.
class TextCursor {
public:
    /// - line: number of the first line of text
    /// - comment: what starts with this character runs to the end of its line and is not read; 0 for no comments
    explicit TextCursor(std::string_view text, char comment = 0, std::size_t line = 1)
        : text_(text), comment_(comment), line_(line) {}

    /// The next word on the current line; empty when the line or the text ends there.
    [[nodiscard]] std::string_view word_on_line();

    /// The next word on this or a later line; empty at the end of the text.
    [[nodiscard]] std::string_view word();

    /// Like word(), but stays where it is.
    [[nodiscard]] std::string_view peek_word();

    /// What is left of the current line, without blanks at its ends and without a comment. Stays on the line.
    [[nodiscard]] std::string_view rest_of_line();

    /// Moves to the start of the next line, whatever stands before it.
    void next_line();

    /// True when nothing but white space and comments is left.
    [[nodiscard]] bool at_end();

    /// The next word as a finite number of a size that fits a float.
    /// - throws BrokenContent that names the line and what was wanted
    [[nodiscard]] double number(const char* wanted);

    /// The next word as a whole number.
    /// - throws BrokenContent that names the line and what was wanted
    [[nodiscard]] std::int64_t integer(const char* wanted);

    /// - throws BrokenContent unless the current line ends here
    void expect_end_of_line(const char* after);

    [[nodiscard]] std::size_t line() const { return line_; }
    [[nodiscard]] std::size_t remaining() const { return text_.size() - position_; }

    /// - throws BrokenContent: "line 12: " and the message
    [[noreturn]] void fail(const std::string& message) const;

private:
    void skip_blanks();
    void skip_space();
    [[nodiscard]] std::size_t end_of_word() const;

    std::string_view text_;
    std::size_t position_ = 0;
    char comment_;
    std::size_t line_;
};

/// A number as the text formats write it: decimal, with or without exponent and sign, also "nan" and "inf". A number
/// beyond the range of doubles is infinite, one too small for them is 0. Nothing for any other text.
[[nodiscard]] std::optional<double> number_from_text(std::string_view text);

/// A decimal whole number with or without sign; nothing for any other text and for one beyond 64 bits.
[[nodiscard]] std::optional<std::int64_t> integer_from_text(std::string_view text);

/// A finite coordinate that keeps areas within the range of floats.
[[nodiscard]] bool is_usable_coordinate(double value);

/// The word in quotes, shortened and printable, for error messages; "the end of the line" for an empty one.
[[nodiscard]] std::string quoted(std::string_view word);

}  // namespace vmap
