// SPDX-License-Identifier: GPL-3.0-or-later
#include <vmap/exporters/base64.h>

#include <cstddef>
#include <cstdint>

namespace vmap {

std::string base64(std::string_view bytes) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text((bytes.size() + 2) / 3 * 4, '=');
    std::size_t out = 0;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k, ++out)
            if (i + k <= bytes.size()) text[out] = digits[group >> (18 - 6 * k) & 63U];
    }
    return text;
}

}  // namespace vmap
