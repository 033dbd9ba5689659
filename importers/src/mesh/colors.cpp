// SPDX-License-Identifier: GPL-3.0-or-later
#include "colors.h"

#include <vmap/srgb.h>

#include <algorithm>

namespace vmap {
namespace {

void decode(std::vector<Imath::C3f>& colors, float white) {
    for (Imath::C3f& color : colors)
        for (int channel = 0; channel < 3; ++channel) color[channel] = linear_from_srgb(color[channel] / white);
}

}  // namespace

void decode_ply_colors(PlyType type, std::vector<Imath::C3f>& colors) {
    if (!is_integer(type))
        decode(colors, 1);
    else
        decode(colors, type == PlyType::uint16 || type == PlyType::int16 ? 65535.0F : 255.0F);
}

void decode_text_colors(std::vector<Imath::C3f>& colors) {
    const bool bytes = std::any_of(colors.begin(), colors.end(),
                                   [](const Imath::C3f& color) { return color.x > 1 || color.y > 1 || color.z > 1; });
    decode(colors, bytes ? 255.0F : 1.0F);
}

}  // namespace vmap
