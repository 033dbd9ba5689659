// SPDX-License-Identifier: GPL-3.0-or-later
#include "node_graph.h"

#include "../content_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace vmap::gltf {
namespace {

/// The parent of each node, Node::none for roots.
std::vector<std::uint32_t> find_parents(const std::vector<Node>& nodes) {
    std::vector<std::uint32_t> parents(nodes.size(), Node::none);
    for (std::uint32_t i = 0; i < nodes.size(); ++i)
        for (const std::uint32_t child : nodes[i].children) {
            if (parents[child] != Node::none)
                throw BrokenContent(
                    fmt::format("nodes[{}] is a child of nodes[{}] and of nodes[{}]", child, parents[child], i));
            parents[child] = i;
        }
    return parents;
}

/// Every node after its parent, depth first.
std::vector<std::uint32_t> depth_first(const std::vector<Node>& nodes, std::vector<std::uint32_t> stack) {
    std::vector<std::uint32_t> order;
    order.reserve(stack.size());
    std::reverse(stack.begin(), stack.end());
    while (!stack.empty()) {
        const std::uint32_t node = stack.back();
        stack.pop_back();
        order.push_back(node);
        stack.insert(stack.end(), nodes[node].children.rbegin(), nodes[node].children.rend());
    }
    return order;
}

std::vector<std::uint32_t> roots_of(const std::vector<std::uint32_t>& parents) {
    std::vector<std::uint32_t> roots;
    for (std::uint32_t i = 0; i < parents.size(); ++i)
        if (parents[i] == Node::none) roots.push_back(i);
    return roots;
}

void check_scenes(const Document& document, const std::vector<std::uint32_t>& parents) {
    std::vector<std::size_t> named_by(document.nodes.size(), document.scenes.size());
    for (std::size_t scene = 0; scene < document.scenes.size(); ++scene)
        for (const std::size_t root : document.scenes[scene].roots) {
            if (parents[root] != Node::none)
                throw BrokenContent(fmt::format("scenes[{}] names nodes[{}], which is a child of nodes[{}]", scene,
                                                root, parents[root]));
            if (named_by[root] == scene)
                throw BrokenContent(fmt::format("scenes[{}] names nodes[{}] twice", scene, root));
            named_by[root] = scene;
        }
}

}  // namespace

void place_nodes(Document& document) {
    const std::vector<std::uint32_t> parents = find_parents(document.nodes);
    check_scenes(document, parents);
    const std::vector<std::uint32_t> order = depth_first(document.nodes, roots_of(parents));
    if (order.size() != document.nodes.size()) throw BrokenContent("the nodes form a cycle");
    for (const std::uint32_t i : order) {
        if (parents[i] == Node::none) continue;
        Node& node = document.nodes[i];
        const Node& parent = document.nodes[parents[i]];
        node.pose = node.pose * parent.pose;
        node.visible = node.visible && parent.visible;
    }
}

std::optional<std::size_t> find_scene(const Document& document, const std::optional<std::string>& wanted) {
    const std::vector<SceneEntry>& scenes = document.scenes;
    if (!wanted) {
        if (scenes.empty()) return std::nullopt;
        return document.default_scene.value_or(0);
    }
    for (std::size_t i = 0; i < scenes.size(); ++i)
        if (scenes[i].name == *wanted) return i;
    std::size_t index = 0;
    const char* const end = wanted->data() + wanted->size();
    const auto [stop, error] = std::from_chars(wanted->data(), end, index);
    if (error != std::errc() || stop != end || index >= scenes.size()) return std::nullopt;
    return index;
}

std::vector<std::uint32_t> nodes_of(const Document& document, const SceneEntry& scene) {
    return depth_first(document.nodes, {scene.roots.begin(), scene.roots.end()});
}

}  // namespace vmap::gltf
