// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Base64 (RFC 4648) for data that texts embed.
#pragma once

#include <string>
#include <string_view>

namespace vmap {

/// The text of the bytes, padded with '='. Texts of pieces join to the text of the whole when all pieces but the last
/// have a size that divides by three.
[[nodiscard]] std::string base64(std::string_view bytes);

}  // namespace vmap
