// SPDX-License-Identifier: GPL-3.0-or-later
// What a document says about itself: its version and the extensions it needs. Read first, so that a file that asks for
// something unknown is not refused for a reason that would mislead.
#include "../content_error.h"
#include "../warnings.h"
#include "document_parts.h"
#include "extensions.h"
#include "json_object.h"

#include <vmap/printable.h>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace vmap::gltf {
namespace {

/// "2.17" has the form major.minor.
struct Version {
    int major_number = 0;
    int minor_number = 0;
};

std::optional<int> small_number(std::string_view text) {
    if (text.empty() || text.size() > 4) return std::nullopt;
    int number = 0;
    for (const char c : text) {
        if (c < '0' || c > '9') return std::nullopt;
        number = number * 10 + (c - '0');
    }
    return number;
}

Version read_version(const JsonObject& asset, const char* key) {
    const std::string text = asset.required(asset.text(key), key);
    const std::size_t dot = text.find('.');
    const std::optional<int> major_number = small_number(std::string_view(text).substr(0, dot));
    const std::optional<int> minor_number =
        dot == std::string::npos ? std::nullopt : small_number(std::string_view(text).substr(dot + 1));
    if (!major_number || !minor_number) asset.fail(key, "a version like '2.0'");
    return {*major_number, *minor_number};
}

std::string text_of(const Version& version) {
    return fmt::format("{}.{}", version.major_number, version.minor_number);
}

void check_asset(const JsonObject& root) {
    const JsonObject asset = root.required(root.object("asset"), "asset");
    const Version version = read_version(asset, "version");
    if (version.major_number != 2)
        throw UnsupportedContent(fmt::format("glTF version {}, expected 2.x", text_of(version)));
    if (!asset.has("minVersion")) return;
    const Version needed = read_version(asset, "minVersion");
    if (needed.major_number != 2 || needed.minor_number != 0)
        throw UnsupportedContent(fmt::format("needs glTF version {}, expected 2.0", text_of(needed)));
}

/// What a writer of ours left in the asset; nothing when another program wrote the file.
std::optional<OwnFile> read_own(const JsonObject& asset) {
    const bool ours = asset.text("generator").value_or("").starts_with("vmap ");
    const std::string units = asset.extra_text("light_units").value_or("");
    const std::string up = asset.extra_text("up").value_or("");
    if (!ours || units.empty() || (up != "y" && up != "z")) return std::nullopt;
    OwnFile own;
    if (units == "spec") own.light_units = LightUnits::spec;
    if (units == "raw") own.light_units = LightUnits::raw;
    own.up = up == "z" ? UpAxis::z : UpAxis::y;
    own.exposure = asset.extra_number("exposure").value_or(1);
    own.source = printable(asset.extra_text("source").value_or(""));
    return own;
}

}  // namespace

void read_asset_and_extensions(const JsonObject& root, Document& document, Warnings& warnings) {
    check_asset(root);
    document.own = read_own(root.required(root.object("asset"), "asset"));
    for (const std::string& name : root.texts("extensionsRequired"))
        if (find_extension(name).support == ExtensionSupport::unknown)
            throw UnsupportedContent(fmt::format("requires the extension '{}', which is not supported", name));

    document.extensions_used = root.texts("extensionsUsed");
    for (const std::string& name : document.extensions_used) {
        const Extension extension = find_extension(name);
        if (extension.support == ExtensionSupport::unknown)
            warnings.add("optional extensions that are not known are ignored", name);
        else if (!extension.warning.empty())
            warnings.add(std::string(extension.warning));
    }
}

}  // namespace vmap::gltf
