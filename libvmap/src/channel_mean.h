// SPDX-License-Identifier: Apache-2.0
/// \file
/// One number for a light of three channels, to compare and to weigh by.
#pragma once

#include <Imath/ImathColor.h>

namespace vmap {

[[nodiscard]] inline float mean_of(const Imath::C3f& c) {
    return (c.x + c.y + c.z) / 3;
}

}  // namespace vmap
