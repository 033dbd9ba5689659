// SPDX-License-Identifier: Apache-2.0
#include "tree_leaves.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vmap {
namespace {

using Imath::V3d;
using Imath::V3f;

/// Sums over the points of a leaf.
struct LeafSums {
    V3d position{0, 0, 0};
    V3d normal{0, 0, 0};
    double area = 0;
};

LeafSums sum_points(const PointCloud& cloud, std::span<const std::uint32_t> points) {
    LeafSums sums;
    for (const std::uint32_t i : points) {
        sums.position += V3d(cloud.positions[i]);
        sums.normal += V3d(cloud.normals[i]);
        if (!cloud.areas.empty()) sums.area += cloud.areas[i];
    }
    return sums;
}

/// Area of the rectangle that has the same second moments as the points have within their tangent plane: what a leaf
/// covers when the cloud does not say.
double moment_area(const PointCloud& cloud, std::span<const std::uint32_t> points, const V3d& centroid,
                   const V3d& normal) {
    const V3d tangent = (std::abs(normal.x) < 0.5 ? V3d(1, 0, 0) : V3d(0, 1, 0)).cross(normal).normalized();
    const V3d bitangent = normal.cross(tangent);
    double uu = 0;
    double uv = 0;
    double vv = 0;
    for (const std::uint32_t i : points) {
        const V3d from_centroid = V3d(cloud.positions[i]) - centroid;
        const double u = tangent.dot(from_centroid);
        const double v = bitangent.dot(from_centroid);
        uu += u * u;
        uv += u * v;
        vv += v * v;
    }
    return 12 * std::sqrt(std::max(0.0, uu * vv - uv * uv)) / static_cast<double>(points.size());
}

/// R and thickness, from the distribution of the points around the leaf's centroid and tangent plane.
void measure_spread(const PointCloud& cloud, std::span<const std::uint32_t> points, const V3d& centroid,
                    const V3d& normal, TreeLeaf& leaf) {
    double largest_squared = 0;
    double thickness = 0;
    for (const std::uint32_t i : points) {
        const V3d from_centroid = V3d(cloud.positions[i]) - centroid;
        const double height = normal.dot(from_centroid);
        thickness = std::max(thickness, std::abs(height));
        largest_squared = std::max(largest_squared, from_centroid.length2() - height * height);
    }
    const double area = leaf.area > 0 ? leaf.area : moment_area(cloud, points, centroid, normal);
    const double spacing = std::sqrt(area / static_cast<double>(points.size()));
    leaf.radius = static_cast<float>(std::sqrt(std::max(0.0, largest_squared)) + spacing * std::numbers::sqrt2 / 2);
    leaf.thickness = static_cast<float>(thickness);
}

TreeLeaf make_leaf(const PointCloud& cloud, std::span<const std::uint32_t> points, TreeNode& node) {
    const LeafSums sums = sum_points(cloud, points);
    const V3d centroid = sums.position / static_cast<double>(points.size());
    V3d normal = sums.normal.normalized();
    if (normal.length2() == 0) normal = V3d(0, 0, 1);  // only normals of length zero: any direction does

    TreeLeaf leaf;
    leaf.centroid = V3f(centroid);
    leaf.normal = V3f(normal);
    leaf.area = static_cast<float>(sums.area);
    measure_spread(cloud, points, centroid, normal, leaf);

    node.cone_axis = leaf.normal;
    node.cone_cos = 1;
    for (const std::uint32_t i : points) {
        node.bounds.extendBy(cloud.positions[i]);
        node.cone_cos = std::min(node.cone_cos, leaf.normal.dot(cloud.normals[i]));
    }
    node.cone_cos = std::max(node.cone_cos, -1.0F);
    return leaf;
}

/// Box and normal cone of an inner node around those of its children.
void bound_children(const Tree& tree, TreeNode& node) {
    const auto children = std::span(tree.nodes).subspan(node.first_child, node.child_count);
    V3d axis(0);
    for (const TreeNode& child : children) {
        node.bounds.extendBy(child.bounds);
        axis += V3d(child.cone_axis) * child.point_count;
    }
    node.cone_cos = -1;
    if (axis.length2() == 0) return;
    axis.normalize();
    node.cone_axis = V3f(axis);

    double widest = 0;
    for (const TreeNode& child : children) {
        const double to_child = std::acos(std::clamp(axis.dot(V3d(child.cone_axis)), -1.0, 1.0));
        widest = std::max(widest, to_child + std::acos(static_cast<double>(child.cone_cos)));
    }
    if (widest < std::numbers::pi) node.cone_cos = static_cast<float>(std::cos(widest));
}

}  // namespace

std::vector<std::uint32_t> leaf_nodes_in_point_order(const Tree& tree) {
    std::vector<std::uint32_t> nodes;
    for (std::uint32_t n = 0; n < tree.nodes.size(); ++n)
        if (tree.nodes[n].is_leaf()) nodes.push_back(n);
    std::ranges::sort(nodes, {}, [&](std::uint32_t n) { return tree.nodes[n].first_point; });
    return nodes;
}

void complete_tree(const PointCloud& cloud, Tree& tree) {
    const std::vector<std::uint32_t> leaf_nodes = leaf_nodes_in_point_order(tree);
    tree.leaves.resize(leaf_nodes.size());
    tbb::parallel_for(std::size_t{0}, leaf_nodes.size(), [&](std::size_t l) {
        TreeNode& node = tree.nodes[leaf_nodes[l]];
        node.leaf = static_cast<std::uint32_t>(l);
        tree.leaves[l] = make_leaf(cloud, tree.points_of(node), node);
        tree.leaves[l].node = leaf_nodes[l];
    });
    for (std::size_t n = tree.nodes.size(); n-- > 0;)
        if (!tree.nodes[n].is_leaf()) bound_children(tree, tree.nodes[n]);
}

}  // namespace vmap
