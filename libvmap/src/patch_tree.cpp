// SPDX-License-Identifier: Apache-2.0
#include "tree_leaves.h"

#include <vmap/error.h>
#include <vmap/patch_tree.h>

#include <Imath/ImathBox.h>

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>

namespace vmap {
namespace {

using Imath::V2f;
using Imath::V3f;

/// Cells of one patch: nodes whose indices and points count from 0, the patch itself first.
struct PatchCells {
    std::vector<TreeNode> nodes;
    std::vector<std::uint32_t> points;  ///< indices into the cloud
};

class PatchCutter {
public:
    PatchCutter(const PointCloud& cloud, const Patch& patch, const PatchTreeConfig& config)
        : cloud_(cloud), patch_(patch), config_(config) {}

    PatchCells cut(std::span<const std::uint32_t> points) {
        cells_.points.assign(points.begin(), points.end());
        cells_.nodes.emplace_back().point_count = static_cast<std::uint32_t>(points.size());
        for (std::size_t n = 0; n < cells_.nodes.size(); ++n) split(n);
        return std::move(cells_);
    }

private:
    void split(std::size_t n) {
        const std::uint32_t first = cells_.nodes[n].first_point;
        const std::uint32_t count = cells_.nodes[n].point_count;
        const auto points = std::span(cells_.points).subspan(first, count);
        Imath::Box2f box;
        for (const std::uint32_t i : points) box.extendBy(patch_.to_plane(cloud_.positions[i]));
        const V2f size = box.size();
        const V2f middle = box.center();
        const bool too_many = config_.points_per_leaf > 0 && count > config_.points_per_leaf;
        const float limit =
            config_.cell_size > 0 ? static_cast<float>(config_.cell_size) : std::numeric_limits<float>::infinity();
        const auto too_long = [&](float side, float other) { return side > limit || (too_many && 2 * side > other); };
        const bool cut_x = size.x > 0 && too_long(size.x, size.y);
        const bool cut_y = size.y > 0 && too_long(size.y, size.x);
        if (!cut_x && !cut_y) return;

        const auto quarter = [&](std::uint32_t i) {
            const V2f at = patch_.to_plane(cloud_.positions[i]);
            return (cut_x && at.x > middle.x ? 1U : 0U) + (cut_y && at.y > middle.y ? 2U : 0U);
        };
        std::ranges::stable_sort(points, {}, quarter);
        std::array<std::uint32_t, 4> counts{};
        for (const std::uint32_t i : points) ++counts.at(quarter(i));
        const auto children = static_cast<std::uint32_t>(4 - std::ranges::count(counts, 0U));
        if (children == 1) return;  // rounding put the middle onto an end
        cells_.nodes[n].first_child = static_cast<std::uint32_t>(cells_.nodes.size());
        cells_.nodes[n].child_count = children;
        std::uint32_t next = first;
        for (const std::uint32_t part : counts) {
            if (part == 0) continue;
            TreeNode& child = cells_.nodes.emplace_back();
            child.first_point = next;
            child.point_count = part;
            next += part;
        }
    }

    const PointCloud& cloud_;
    const Patch& patch_;
    const PatchTreeConfig& config_;
    PatchCells cells_;
};

/// Six classes by the dominant axis of the normal, as in octrees: narrow cones keep facing tests sharp high up.
int orientation_class(const V3f& normal) {
    int axis = 0;
    for (int other = 1; other < 3; ++other)
        if (std::abs(normal[other]) > std::abs(normal[axis])) axis = other;
    return 2 * axis + (normal[axis] < 0 ? 1 : 0);
}

/// Joins patches into a tree over them.
class PatchJoiner {
public:
    PatchJoiner(PatchSet& set, std::vector<PatchCells> cells, std::size_t points)
        : set_(set), cells_(std::move(cells)), order_(set.patches.size()) {
        std::iota(order_.begin(), order_.end(), 0U);
        tree_.point_order.reserve(points);
    }

    Tree join() {
        std::ranges::stable_sort(order_, {},
                                 [&](std::uint32_t p) { return orientation_class(set_.patches[p].normal); });
        std::vector<std::uint32_t> class_begins;
        for (std::uint32_t i = 0; i < order_.size(); ++i)
            if (i == 0 || class_at(i) != class_at(i - 1)) class_begins.push_back(i);
        class_begins.push_back(static_cast<std::uint32_t>(order_.size()));

        tree_.nodes.emplace_back();
        const std::size_t classes = class_begins.size() - 1;
        if (classes == 1) {
            place(0, 0, class_begins[1]);
        } else {
            const std::uint32_t first = add_children(0, classes);
            for (std::uint32_t c = 0; c < classes; ++c) place(first + c, class_begins[c], class_begins[c + 1]);
        }
        sum_points();
        return std::move(tree_);
    }

private:
    [[nodiscard]] int class_at(std::uint32_t i) const { return orientation_class(set_.patches[order_[i]].normal); }

    std::uint32_t add_children(std::uint32_t node, std::size_t count) {
        const auto first = static_cast<std::uint32_t>(tree_.nodes.size());
        tree_.nodes[node].first_child = first;
        tree_.nodes[node].child_count = static_cast<std::uint32_t>(count);
        tree_.nodes.resize(tree_.nodes.size() + count);
        return first;
    }

    /// Makes a node the root of patches begin to end of the order.
    void place(std::uint32_t node, std::uint32_t begin, std::uint32_t end) {
        if (end - begin == 1) return place_patch(node, order_[begin]);
        Imath::Box3f centers;
        for (std::uint32_t i = begin; i < end; ++i) centers.extendBy(set_.patches[order_[i]].center);
        const int axis = static_cast<int>(centers.majorAxis());
        const std::uint32_t middle = begin + (end - begin) / 2;
        const auto key = [&](std::uint32_t p) { return std::pair(set_.patches[p].center[axis], p); };
        std::ranges::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, {}, key);
        const std::uint32_t first = add_children(node, 2);
        place(first, begin, middle);
        place(first + 1, middle, end);
    }

    void place_patch(std::uint32_t node, std::uint32_t p) {
        const PatchCells& cells = cells_[p];
        const auto first_point = static_cast<std::uint32_t>(tree_.point_order.size());
        const auto first_node = static_cast<std::uint32_t>(tree_.nodes.size()) - 1;  // of all but the patch itself
        for (std::uint32_t i = 0; i < cells.nodes.size(); ++i) {
            TreeNode& own = i == 0 ? tree_.nodes[node] : tree_.nodes.emplace_back();
            own = cells.nodes[i];
            own.first_point += first_point;
            own.patch = p;
            if (own.child_count > 0) own.first_child += first_node;
        }
        tree_.point_order.insert(tree_.point_order.end(), cells.points.begin(), cells.points.end());
        set_.patches[p].first_point = first_point;
    }

    void sum_points() {
        for (std::size_t n = tree_.nodes.size(); n-- > 0;) {
            TreeNode& node = tree_.nodes[n];
            if (node.patch != no_index) continue;
            node.first_point = tree_.nodes[node.first_child].first_point;
            for (std::uint32_t c = 0; c < node.child_count; ++c)
                node.point_count += tree_.nodes[node.first_child + c].point_count;
        }
    }

    PatchSet& set_;
    std::vector<PatchCells> cells_;
    std::vector<std::uint32_t> order_;
    Tree tree_;
};

std::vector<PatchCells> cut_patches(const PointCloud& cloud, const PatchSet& set, const PatchTreeConfig& config) {
    if (!(config.cell_size >= 0) || !std::isfinite(config.cell_size))
        throw UsageError("patch cell size is " + std::to_string(config.cell_size) + "; expected 0 or more");
    std::vector<PatchCells> cells(set.patches.size());
    tbb::parallel_for(std::size_t{0}, cells.size(), [&](std::size_t p) {
        cells[p] = PatchCutter(cloud, set.patches[p], config).cut(set.points_of(set.patches[p]));
    });
    return cells;
}

}  // namespace

Tree build_patch_tree(const PointCloud& cloud, PatchSet& set, const PatchTreeConfig& config) {
    std::vector<PatchCells> cells = cut_patches(cloud, set, config);
    if (cells.empty()) return {};
    Tree tree = PatchJoiner(set, std::move(cells), cloud.size()).join();
    set.point_order = tree.point_order;
    complete_tree(cloud, tree);
    return tree;
}

PatchTreeConfig patch_tree_config_for_leaves(const PointCloud& cloud, const PatchSet& set, std::size_t leaves) {
    PatchTreeConfig best;
    Imath::Box3f box;
    for (const V3f& p : cloud.positions) box.extendBy(p);
    const double extent = box.isEmpty() ? 0 : static_cast<double>(box.size().length());
    if (!(extent > 0) || !std::isfinite(extent)) return best;

    std::size_t best_miss = no_index;
    double low = std::log(extent * 1e-5);
    double high = std::log(extent);
    for (int step = 0; step < 16 && best_miss > 0; ++step) {
        const PatchTreeConfig trial{.cell_size = std::exp((low + high) / 2)};
        std::size_t count = 0;
        for (const PatchCells& cells : cut_patches(cloud, set, trial))
            count += static_cast<std::size_t>(std::ranges::count_if(cells.nodes, &TreeNode::is_leaf));
        const std::size_t miss = count > leaves ? count - leaves : leaves - count;
        if (miss < best_miss) {
            best_miss = miss;
            best = trial;
        }
        (count > leaves ? low : high) = (low + high) / 2;
    }
    return best;
}

}  // namespace vmap
