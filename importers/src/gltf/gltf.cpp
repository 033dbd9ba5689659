// SPDX-License-Identifier: GPL-3.0-or-later
// The document is read by nlohmann-json through a typed, checking reader, not by tinygltf. tinygltf is a parser: it
// drops members of the wrong type without a word, follows references out of the scene's folder, trusts lengths and
// recurses by the file's nesting. A gate before it would have to check every member of the text, which is the whole
// work of reading it; a second parse after that would only cost time. Debian's libdraco, which unpacks meshes here,
// also exports a tinygltf of another version, and two in one process crash. A test lets tinygltf read the bundled
// scenes and compares.
#include <vmap/importers/gltf.h>

#include "../content_error.h"
#include "../file_bytes.h"
#include "../scene_folder.h"
#include "../warnings.h"
#include "buffers.h"
#include "container.h"
#include "document.h"
#include "json_object.h"
#include "limits.h"
#include "node_graph.h"
#include "scene_builder.h"

#include <vmap/error.h>
#include <vmap/printable.h>

#include <fmt/format.h>

namespace vmap {
namespace {

std::string message(const std::filesystem::path& file, const char* problem) {
    return fmt::format("{}: {}", printable(file.string()), printable(problem));
}

/// The document without the text that it came from.
gltf::Document parse(const gltf::Container& container, LightUnits units, Warnings& warnings) {
    const gltf::JsonDocument json(container.json);
    return gltf::read_document(json.root(), units, warnings);
}

Input import_unnamed(const std::filesystem::path& file, const InputConfig& config) {
    const Bytes bytes = read_file(file, gltf::largest_file);
    const gltf::Container container = gltf::open_container(bytes.span());
    Warnings warnings;
    gltf::Document document = parse(container, config.light_units, warnings);
    gltf::place_nodes(document);
    const std::optional<std::size_t> scene = gltf::find_scene(document, config.scene);
    if (!scene && config.scene)
        throw UsageError(fmt::format("{}: has no scene '{}', expected a name or an index below {}",
                                     printable(file.string()), printable(*config.scene), document.scenes.size()));
    if (!scene) throw UnsupportedContent("holds no scene");

    const SceneFolder folder(file);
    gltf::Buffers buffers(document, folder, container.bin);
    Input input = gltf::build_scene(document, document.scenes[*scene], buffers, folder, warnings);
    input.facts.format = container.is_glb ? "glTF, binary" : "glTF, text";
    input.facts.up = document.own ? document.own->up : UpAxis::y;
    input.scene.source = printable(file.filename().string());
    input.scene.warnings = warnings.lines();
    for (const std::string& name : document.extensions_used) input.scene.extensions.push_back(printable(name));
    return input;
}

}  // namespace

Input import_gltf(const std::filesystem::path& file, const InputConfig& config) {
    try {
        return import_unnamed(file, config);
    } catch (const BrokenContent& error) {
        throw FileError(message(file, error.what()));
    } catch (const UnsupportedContent& error) {
        throw UnsupportedInput(message(file, error.what()));
    }
}

}  // namespace vmap
