// SPDX-License-Identifier: GPL-3.0-or-later
#include "check_picture.h"
#include "seekable_output.h"

#include <vmap/error.h>
#include <vmap/exporters/exr.h>
#include <vmap/printable.h>
#include <vmap/version.h>

#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>

#include <cstdint>
#include <string>

namespace vmap {
namespace {

/// Lets OpenEXR write to a stream that throws.
class ExrStream : public Imf::OStream {
public:
    ExrStream(std::ostream& stream, const std::string& name) : OStream(name.c_str()), stream_(stream) {}

    void write(const char* data, int size) override { stream_.write(data, size); }
    std::uint64_t tellp() override { return static_cast<std::uint64_t>(std::streamoff(stream_.tellp())); }
    void seekp(std::uint64_t position) override { stream_.seekp(static_cast<std::streamoff>(position)); }

private:
    std::ostream& stream_;
};

Imf::Header header_of(const Picture& picture, const OutputInfo& info) {
    Imf::Header header(picture.width, picture.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const char* channel : {"R", "G", "B"}) header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
    if (!picture.alpha.empty()) header.channels().insert("A", Imf::Channel(Imf::FLOAT));

    header.insert("light_units", Imf::StringAttribute(std::string(name_of(info.light_units))));
    header.insert("light_factor_punctual", Imf::DoubleAttribute(punctual_factor(info.light_units)));
    header.insert("light_factor_directional", Imf::DoubleAttribute(directional_factor(info.light_units)));
    header.insert("exposure", Imf::DoubleAttribute(info.exposure));
    header.insert("vmap", Imf::StringAttribute(version));
    header.insert("source", Imf::StringAttribute(header_text(info.source)));
    return header;
}

/// OpenEXR only reads through the pointer.
Imf::Slice slice_of(const float* first, const Picture& picture, std::size_t stride) {
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast)
    char* base = reinterpret_cast<char*>(const_cast<float*>(first));
    return Imf::Slice(Imf::FLOAT, base, stride, stride * static_cast<std::size_t>(picture.width));
}

}  // namespace

void write_exr(FileWriter& file, const Picture& picture, const OutputInfo& info) {
    check_picture(picture, file.path());
    Imf::FrameBuffer pixels;
    const char* names[] = {"R", "G", "B"};
    for (int channel = 0; channel < 3; ++channel)
        pixels.insert(names[channel], slice_of(&picture.pixels[0].x + channel, picture, sizeof(Imath::C3f)));
    if (!picture.alpha.empty()) pixels.insert("A", slice_of(picture.alpha.data(), picture, sizeof(float)));

    write_seekable(file, [&](std::ostream& stream) {
        ExrStream exr_stream(stream, printable(file.path()));
        Imf::OutputFile output(exr_stream, header_of(picture, info));
        output.setFrameBuffer(pixels);
        output.writePixels(picture.height);
    });
}

}  // namespace vmap
