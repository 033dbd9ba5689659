// SPDX-License-Identifier: Apache-2.0
#include <vmap/printable.h>

#include <cstddef>

namespace vmap {
namespace {

unsigned byte_at(std::string_view text, std::size_t i) {
    return static_cast<unsigned char>(text[i]);
}

/// Length of the well-formed UTF-8 sequence that starts at i; 0 when there is none.
std::size_t sequence_length(std::string_view text, std::size_t i) {
    const unsigned lead = byte_at(text, i);
    if (lead < 0x80) return 1;
    const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
    if (lead < 0xC2 || lead > 0xF4 || i + length > text.size()) return 0;
    for (std::size_t k = 1; k < length; ++k)
        if ((byte_at(text, i + k) & 0xC0) != 0x80) return 0;

    // Overlong forms, surrogates and code points past U+10FFFF.
    const unsigned second = byte_at(text, i + 1);
    const bool malformed = (lead == 0xE0 && second < 0xA0) || (lead == 0xED && second >= 0xA0) ||
                           (lead == 0xF0 && second < 0x90) || (lead == 0xF4 && second >= 0x90);
    return malformed ? 0 : length;
}

bool is_control(std::string_view sequence) {
    const unsigned lead = byte_at(sequence, 0);
    if (lead < 0x20 || lead == 0x7F) return true;
    if (lead == 0xC2 && byte_at(sequence, 1) < 0xA0) return true;  // C1 controls
    // Line and paragraph separators and the marks that reverse the direction of text.
    return sequence.starts_with("\xE2\x80") && (byte_at(sequence, 2) == 0xA8 || byte_at(sequence, 2) == 0xA9 ||
                                                (byte_at(sequence, 2) >= 0xAA && byte_at(sequence, 2) <= 0xAE));
}

void append_escaped(std::string& out, unsigned byte) {
    constexpr std::string_view digits = "0123456789abcdef";
    if (byte == '\n')
        out += "\\n";
    else if (byte == '\r')
        out += "\\r";
    else if (byte == '\t')
        out += "\\t";
    else {
        out += "\\x";
        out += digits[byte >> 4];
        out += digits[byte & 15];
    }
}

}  // namespace

std::string printable(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t length = sequence_length(text, i);
        const std::string_view sequence = text.substr(i, length > 0 ? length : 1);
        if (length > 0 && !is_control(sequence))
            out += sequence;
        else
            for (std::size_t k = 0; k < sequence.size(); ++k) append_escaped(out, byte_at(sequence, k));
        i += sequence.size();
    }
    return out;
}

}  // namespace vmap
