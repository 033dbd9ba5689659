// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Values of options that are more than one number.
#pragma once

#include <vmap/light_source.h>

#include <Imath/ImathColor.h>
#include <Imath/ImathVec.h>

#include <string>
#include <string_view>
#include <vector>

namespace vmap {

/// Numbers between commas.
/// - option: names the option in the message
/// - throws UsageError unless there are `least` to `most` finite numbers
[[nodiscard]] std::vector<double> parse_numbers(std::string_view option, std::string_view text, std::size_t least,
                                                std::size_t most);

/// "X,Y,Z"
[[nodiscard]] Imath::V3d parse_vector(std::string_view option, std::string_view text);

/// One number for all channels or three.
[[nodiscard]] Imath::C3f parse_color(std::string_view option, std::string_view text);

/// "point:X,Y,Z:I" or "sun:DX,DY,DZ:E"; I in W/sr, E in W/m^2, one number or three.
[[nodiscard]] LightSource parse_light(std::string_view text);

}  // namespace vmap
