// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A glTF document as typed data. Every index points into its array and every range lies inside its buffer: later steps
/// read it without looking back. Bytes are not loaded yet.
#pragma once

#include <vmap/axes.h>
#include <vmap/light_units.h>
#include <vmap/scene.h>

#include <Imath/ImathMatrix.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace vmap {
class Warnings;
}

namespace vmap::gltf {

class JsonObject;

struct BufferInfo {
    std::uint64_t length = 0;
    std::optional<std::string> uri;  ///< none: the GLB's binary chunk
    bool fallback = false;           ///< without bytes of its own: what refers to it is stored compressed elsewhere
};

enum class MeshoptMode { attributes, triangles, indices };
enum class MeshoptFilter { none, octahedral, quaternion, exponential };

/// EXT_meshopt_compression: where the compressed bytes of a view are.
struct MeshoptView {
    std::size_t buffer = 0;
    std::uint64_t offset = 0;
    std::uint64_t length = 0;
    std::uint64_t count = 0;
    std::uint32_t stride = 0;
    MeshoptMode mode = MeshoptMode::attributes;
    MeshoptFilter filter = MeshoptFilter::none;
};

struct BufferView {
    std::size_t buffer = 0;
    std::uint64_t offset = 0;
    std::uint64_t length = 0;
    std::uint32_t stride = 0;  ///< bytes between elements; 0 when they follow each other
    std::optional<MeshoptView> meshopt;
};

enum class ComponentType { int8 = 5120, uint8 = 5121, int16 = 5122, uint16 = 5123, uint32 = 5125, float32 = 5126 };

[[nodiscard]] std::uint32_t byte_size(ComponentType type);

struct SparseInfo {
    std::uint64_t count = 0;
    ComponentType index_type = ComponentType::uint16;
    std::size_t index_view = 0;
    std::uint64_t index_offset = 0;
    std::size_t value_view = 0;
    std::uint64_t value_offset = 0;
};

struct Accessor {
    std::optional<std::size_t> view;  ///< none: zeros, or compressed in the primitive
    std::uint64_t offset = 0;
    std::uint64_t count = 0;
    ComponentType component = ComponentType::float32;
    std::string type;                ///< "VEC3"
    std::uint32_t components = 1;    ///< per element
    std::uint32_t element_size = 0;  ///< bytes, with the padding of matrices
    bool normalized = false;
    std::optional<SparseInfo> sparse;
};

struct ImageInfo {
    std::string name;
    std::optional<std::string> uri;
    std::size_t view = 0;  ///< when there is no uri
};

using Attributes = std::vector<std::pair<std::string, std::size_t>>;  ///< name -> accessor

[[nodiscard]] std::optional<std::size_t> find_attribute(const Attributes& attributes, const std::string& name);

enum class PrimitiveMode { points, lines, line_loop, line_strip, triangles, triangle_strip, triangle_fan };

/// KHR_draco_mesh_compression: attributes are named by their unique ids in the compressed mesh.
struct DracoInfo {
    std::size_t view = 0;
    Attributes attributes;
};

struct Primitive {
    std::string where;  ///< its place in the document, for messages
    Attributes attributes;
    std::optional<std::size_t> indices;
    std::optional<std::size_t> material;
    PrimitiveMode mode = PrimitiveMode::triangles;
    std::vector<Attributes> targets;
    std::optional<DracoInfo> draco;
};

struct MeshInfo {
    std::string name;
    std::vector<Primitive> primitives;
    std::vector<double> weights;       ///< one per morph target
    std::optional<double> radius;      ///< of the points, from the extras
    std::optional<std::size_t> areas;  ///< accessor with the points' areas, from the extras
};

struct SkinInfo {
    std::vector<std::size_t> joints;  ///< nodes
    std::optional<std::size_t> inverse_bind_matrices;
};

/// EXT_mesh_gpu_instancing
struct InstancingInfo {
    std::optional<std::size_t> translation;
    std::optional<std::size_t> rotation;
    std::optional<std::size_t> scale;
};

/// What few nodes have, kept apart because files may have millions of nodes.
struct NodeExtras {
    std::optional<std::size_t> skin;
    std::vector<double> weights;
    std::optional<InstancingInfo> instancing;
};

struct Node {
    static constexpr std::uint32_t none = 0xFFFFFFFF;

    std::string name;
    Imath::M44d pose;  ///< row vectors: parent_from_node as read, world_from_node after place_nodes
    std::vector<std::uint32_t> children;
    std::uint32_t mesh = none;
    std::uint32_t camera = none;
    std::uint32_t light = none;
    bool visible = true;
    std::unique_ptr<NodeExtras> extras;
};

struct SceneEntry {
    std::string name;
    std::vector<std::size_t> roots;
};

/// What a file of points that this toolkit wrote says about itself.
struct OwnFile {
    LightUnits light_units = LightUnits::compat;
    double exposure = 1;
    std::string source;
    UpAxis up = UpAxis::y;
};

struct Document {
    std::optional<OwnFile> own;
    std::vector<std::string> extensions_used;
    std::vector<BufferInfo> buffers;
    std::vector<BufferView> views;
    std::vector<Accessor> accessors;
    std::vector<ImageInfo> images;
    std::vector<Material> materials;  ///< their textures name images of the document
    std::vector<MeshInfo> meshes;
    std::vector<SkinInfo> skins;
    std::vector<LightSource> lights;  ///< in their nodes' frames
    std::vector<Camera> cameras;      ///< in their nodes' frames
    std::vector<Node> nodes;
    std::vector<SceneEntry> scenes;
    std::optional<std::size_t> default_scene;
};

/// Whether a document uses an extension by its own word.
[[nodiscard]] bool uses_extension(const Document& document, std::string_view name);

/// Reads and checks a document.
///
/// - throws BrokenContent where it breaks the specification, UnsupportedContent when it requires an extension that is
///   not read
[[nodiscard]] Document read_document(const JsonObject& root, LightUnits units, Warnings& warnings);

}  // namespace vmap::gltf
