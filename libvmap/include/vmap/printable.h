// SPDX-License-Identifier: Apache-2.0
/// \file
/// Names of foreign origin, made fit for terminals, headers and logs.
#pragma once

#include <string>
#include <string_view>

namespace vmap {

/// The text on one line without control characters: line breaks, escape sequences and bytes that are not UTF-8 become
/// visible, as in "a\nb" or "\x1b". Everything else is kept.
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace vmap
