// SPDX-License-Identifier: GPL-3.0-or-later
#include "input_format.h"

#include "content_error.h"
#include "mesh/stl.h"
#include "mesh/text_cursor.h"

#include <vmap/printable.h>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <string>

namespace vmap {
namespace {

struct Suffix {
    std::string_view suffix;
    InputFormat format;
};

constexpr Suffix suffixes[] = {
    {".gltf", InputFormat::gltf}, {".glb", InputFormat::gltf},   {".obj", InputFormat::obj},
    {".ply", InputFormat::ply},   {".off", InputFormat::off},    {".coff", InputFormat::off},
    {".noff", InputFormat::off},  {".stl", InputFormat::stl},    {".xyz", InputFormat::xyz},
    {".xyzn", InputFormat::xyz},  {".xyzrgb", InputFormat::xyz}, {".pts", InputFormat::xyz},
    {".asc", InputFormat::xyz},   {".txt", InputFormat::xyz},    {".vmap", InputFormat::vmap},
};

std::string lower(std::string_view text) {
    std::string result(text);
    std::transform(result.begin(), result.end(), result.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return result;
}

std::optional<InputFormat> format_of_suffix(const std::string& suffix) {
    for (const Suffix& known : suffixes)
        if (known.suffix == suffix) return known.format;
    return std::nullopt;
}

/// Formats that people may try and that begin in a way of their own.
void refuse_foreign(std::string_view content) {
    if (content.starts_with("LASF"))
        throw UnsupportedContent("a LAS or LAZ file is not read, expected points as PLY or XYZ");
    if (content.starts_with("solid") || content.empty()) return;
    if (content.starts_with("Kaydara FBX")) throw UnsupportedContent("an FBX file is not read, expected glTF");
    if (content.starts_with("BLENDER")) throw UnsupportedContent("a Blender file is not read, expected glTF");
    if (lower(content.substr(0, 5)) == "<?xml") throw UnsupportedContent("an XML file is not read, expected glTF");
}

/// The format that the first bytes leave no doubt about.
std::optional<InputFormat> format_of_magic(std::string_view content, std::uint64_t size) {
    if (content.starts_with("glTF")) return InputFormat::gltf;
    if (content.starts_with("VMAP")) return InputFormat::vmap;
    if (content.starts_with("ply\n") || content.starts_with("ply\r")) return InputFormat::ply;
    if (is_binary_stl(content, size)) return InputFormat::stl;
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (content.starts_with(byte_order_mark)) content.remove_prefix(byte_order_mark.size());
    const std::string_view word = TextCursor(content, '#').word();
    if (word.starts_with('{')) return InputFormat::gltf;
    if (word == "OFF" || word == "COFF" || word == "NOFF" || word == "CNOFF" || word == "STOFF")
        return InputFormat::off;
    if (lower(word) == "solid") return InputFormat::stl;
    return std::nullopt;
}

/// For a file without a known suffix: what the first word of the text suggests.
std::optional<InputFormat> format_of_text(std::string_view content) {
    TextCursor words(content, '#');
    const std::string_view word = words.word();
    if (word == "v" || word == "mtllib" || word == "o" || word == "g") return InputFormat::obj;
    if (number_from_text(word) && number_from_text(words.word_on_line()) && number_from_text(words.word_on_line()))
        return InputFormat::xyz;
    return std::nullopt;
}

}  // namespace

std::string_view name_of(InputFormat format) {
    switch (format) {
        case InputFormat::gltf:
            return "glTF";
        case InputFormat::obj:
            return "OBJ";
        case InputFormat::ply:
            return "PLY";
        case InputFormat::off:
            return "OFF";
        case InputFormat::stl:
            return "STL";
        case InputFormat::xyz:
            return "XYZ";
        case InputFormat::vmap:
            break;
    }
    return "vmap";
}

InputFormat recognize_format(std::string_view content, std::uint64_t size, const std::filesystem::path& name) {
    if (content.empty()) throw BrokenContent("is empty");
    refuse_foreign(content);
    const std::string suffix = lower(name.extension().string());
    const std::optional<InputFormat> by_name = format_of_suffix(suffix);
    const std::optional<InputFormat> by_content = format_of_magic(content, size);
    if (by_name && by_content && *by_name != *by_content)
        throw BrokenContent(
            fmt::format("is named like a file of {}, but holds {}", name_of(*by_name), name_of(*by_content)));
    if (by_content) return *by_content;
    if (by_name) return *by_name;
    if (const std::optional<InputFormat> by_text = format_of_text(content)) return *by_text;
    throw UnsupportedContent("is of no format that is read, expected glTF, OBJ, PLY, OFF, STL, XYZ or .vmap");
}

}  // namespace vmap
