// SPDX-License-Identifier: GPL-3.0-or-later
#include "pov_text.h"

namespace vmap {

std::string pov_vector(const Imath::V3d& v) {
    return fmt::format("<{}, {}, {}>", v.x, v.y, v.z);
}

std::string pov_color(const Imath::C3f& color) {
    return fmt::format("rgb <{}, {}, {}>", color.x, color.y, color.z);
}

std::string pov_matrix(const Imath::M44d& m) {
    return fmt::format("matrix <{}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}>", m[0][0], m[0][1], m[0][2], m[1][0],
                       m[1][1], m[1][2], m[2][0], m[2][1], m[2][2], m[3][0], m[3][1], m[3][2]);
}

}  // namespace vmap
