// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// URIs as scene files use them: relative references and data URIs (RFC 3986, RFC 2397, RFC 4648).
#pragma once

#include "file_bytes.h"

#include <optional>
#include <string>
#include <string_view>

namespace vmap {

/// Undoes the percent-encoding once. '+' stays as it is.
///
/// - throws BrokenContent for a '%' without two hexadecimal digits and for a reference with a scheme, such as http:
[[nodiscard]] std::string path_from_uri(std::string_view uri);

/// The bytes of a base64 data URI; nothing when the URI is not a data URI.
///
/// - throws BrokenContent for a data URI that is not base64 or is damaged
[[nodiscard]] std::optional<Bytes> bytes_from_data_uri(std::string_view uri);

}  // namespace vmap
