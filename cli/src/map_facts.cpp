// SPDX-License-Identifier: GPL-3.0-or-later
#include "map_facts.h"

#include <vmap/printable.h>
#include <vmap/vmap_file.h>

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace vmap {
namespace {

using Json = nlohmann::ordered_json;

const char* name_of(VisibilityRule rule) {
    return rule == VisibilityRule::patch ? "patch" : "centroid";
}

const char* tree_kind(const VmapContents& contents) {
    if (contents.map.rule == VisibilityRule::patch) return "patch";
    return contents.tree.cells.empty() ? "adaptive" : "uniform";
}

/// By how many per cent there are fewer links than pairs.
Json decrease(std::size_t links, std::uint64_t pairs) {
    if (pairs == 0) return nullptr;
    return 100 * (1 - static_cast<double>(links) / static_cast<double>(pairs));
}

Json as_json(const Imath::V3d& v) {
    return {v.x, v.y, v.z};
}

/// "same" or how many of the larger number of entries differ.
template <class Values>
Json compare(const Values& a, const Values& b) {
    if (a == b) return "same";
    if (a.size() != b.size()) return fmt::format("{} and {}", a.size(), b.size());
    std::size_t differ = 0;
    for (std::size_t i = 0; i < a.size(); ++i) differ += a[i] == b[i] ? 0 : 1;
    return fmt::format("{} of {} differ", differ, a.size());
}

/// Links of one map that the other lacks, both ways.
Json compare_links(std::span<const std::uint64_t> first_a, std::span<const std::uint32_t> a,
                   std::span<const std::uint64_t> first_b, std::span<const std::uint32_t> b) {
    if (std::ranges::equal(first_a, first_b) && std::ranges::equal(a, b)) return "same";
    if (first_a.size() != first_b.size()) return "links of different trees";
    std::size_t common = 0;
    for (std::size_t n = 0; n + 1 < first_a.size(); ++n) {
        const auto links_b = b.subspan(first_b[n], first_b[n + 1] - first_b[n]);
        for (const std::uint32_t partner : a.subspan(first_a[n], first_a[n + 1] - first_a[n]))
            common += std::ranges::binary_search(links_b, partner) ? 1 : 0;
    }
    return fmt::format("{} and {}, {} in common", a.size(), b.size(), common);
}

}  // namespace

bool is_vmap_file(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    std::string magic(4, '\0');
    return stream.read(magic.data(), std::ssize(magic)) && magic == "VMAP";
}

Json map_facts(const std::string& file) {
    const VmapContents contents = read_vmap(file);
    const Tree& tree = contents.tree;
    const VisibilityMap& map = contents.map;
    const std::uint64_t pairs = std::uint64_t{tree.leaves.size()} * tree.leaves.size();
    const std::uint64_t visible = visible_leaf_pairs(tree, map);
    Json json{{"input", printable(file)},
              {"source", printable(contents.source)},
              {"points", contents.cloud.size()},
              {"rule", name_of(map.rule)},
              {"tree", tree_kind(contents)},
              {"nodes", tree.nodes.size()},
              {"leaves", tree.leaves.size()},
              {"patches", contents.patches.patches.size()},
              {"links", map.ordered_links()},
              {"hidden_pairs", map.hidden.size()},
              {"n_squared", pairs},
              {"decrease_percent", decrease(map.ordered_links(), pairs)},
              {"visible_leaf_pairs", visible},
              {"decrease_of_visible_percent", decrease(map.ordered_links(), visible)},
              {"link_bytes", map.partners.size() * sizeof(std::uint32_t)},
              {"bytes", std::filesystem::file_size(file)},
              {"lights", contents.lights.size()},
              {"cameras", contents.cameras.size()},
              {"seconds", {{"tree", contents.tree_seconds}, {"vmap", contents.map_seconds}}}};
    if (!tree.nodes.empty()) {
        const Imath::Box3f& box = tree.nodes[0].bounds;
        json["box"] = {as_json(contents.cloud.origin + Imath::V3d(box.min)),
                       as_json(contents.cloud.origin + Imath::V3d(box.max))};
    }
    return json;
}

Json compare_maps(const std::string& file, const std::string& other) {
    const VmapContents a = read_vmap(file);
    const VmapContents b = read_vmap(other);
    Json points = compare(a.cloud.positions, b.cloud.positions);
    if (points == "same" && a.cloud != b.cloud) points = "attributes differ";
    return {{"points", points},
            {"rule", a.map.rule == b.map.rule ? "same" : "different"},
            {"nodes", compare(a.tree.nodes, b.tree.nodes)},
            {"leaves", compare(a.tree.leaves, b.tree.leaves)},
            {"links", compare_links(a.map.first_link, a.map.partners, b.map.first_link, b.map.partners)},
            {"hidden_pairs", compare_links(a.map.first_hidden, a.map.hidden, b.map.first_hidden, b.map.hidden)},
            {"lights", compare(a.lights, b.lights)}};
}

}  // namespace vmap
