// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What every writer of pictures asks for first.
#pragma once

#include <vmap/error.h>
#include <vmap/exporters/picture.h>
#include <vmap/printable.h>

#include <cassert>
#include <string>

namespace vmap {

/// Throws UsageError for a picture without pixels.
inline void check_picture(const Picture& picture, const std::string& path) {
    if (picture.width < 1 || picture.height < 1)
        throw UsageError(printable(path) + ": a picture of " + std::to_string(picture.width) + " x " +
                         std::to_string(picture.height) + " pixels, expected at least 1 x 1");
    assert(picture.pixels.size() == static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
    assert(picture.alpha.empty() || picture.alpha.size() == picture.pixels.size());
}

}  // namespace vmap
