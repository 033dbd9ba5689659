// SPDX-License-Identifier: GPL-3.0-or-later
#include "check_picture.h"
#include "png_image.h"

#include <vmap/exporters/png.h>
#include <vmap/srgb.h>
#include <vmap/version.h>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <cstdint>
#include <vector>

namespace vmap {

void write_png(FileWriter& file, const Picture& picture, const OutputInfo& info) {
    check_picture(picture, file.path());
    const auto exposure = static_cast<float>(info.exposure);
    std::vector<std::uint8_t> bytes(picture.pixels.size() * 3);
    tbb::parallel_for(std::size_t{0}, picture.pixels.size(), [&](std::size_t i) {
        for (int channel = 0; channel < 3; ++channel)
            bytes[3 * i + static_cast<std::size_t>(channel)] = srgb8_from_linear(exposure * picture.pixels[i][channel]);
    });
    write_png_image(file, {.width = picture.width,
                           .height = picture.height,
                           .bytes = bytes,
                           .texts = {{"Software", fmt::format("vmap {}", version)},
                                     {"Source", header_text(info.source)},
                                     {"Exposure", fmt::format("{}", info.exposure)}}});
}

}  // namespace vmap
