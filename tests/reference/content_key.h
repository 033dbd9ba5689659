// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Names for cached files that follow from what the files depend on.
#pragma once

#include <reference/owen_sobol.h>

#include <Imath/ImathColor.h>
#include <Imath/ImathVec.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iomanip>
#include <sstream>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace vmap::reference {

/// A hash of 128 bits over numbers in the order in which they are added.
class ContentKey {
public:
    void add_bytes(const void* data, std::size_t size) {
        add_word(size);
        const auto* bytes = static_cast<const unsigned char*>(data);
        for (std::size_t i = 0; i < size; i += 8) {
            std::uint64_t word = 0;
            std::memcpy(&word, bytes + i, std::min<std::size_t>(8, size - i));
            add_word(word);
        }
    }
    template <class T>
        requires std::is_arithmetic_v<T> || std::is_enum_v<T>
    void add(T value) {
        add_bytes(&value, sizeof value);
    }
    template <class T>
    void add(const Imath::Vec3<T>& value) {
        add_bytes(&value, sizeof value);
    }
    void add(const Imath::C4f& value) { add_bytes(&value, sizeof value); }
    void add(std::string_view text) { add_bytes(text.data(), text.size()); }
    template <class T>
    void add_all(const std::vector<T>& values) {
        add_bytes(values.data(), values.size() * sizeof(T));
    }

    /// 32 hexadecimal digits.
    [[nodiscard]] std::string text() const {
        std::ostringstream stream;
        stream << std::hex << std::setfill('0') << std::setw(16) << a_ << std::setw(16) << b_;
        return stream.str();
    }

private:
    void add_word(std::uint64_t word) {
        a_ = mix_keys(a_, word);
        b_ = mix_keys(b_ + word, a_);
    }

    std::uint64_t a_ = 0;
    std::uint64_t b_ = 0;
};

}  // namespace vmap::reference
