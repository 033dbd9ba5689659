// SPDX-License-Identifier: Apache-2.0
#include <vmap/polygon_bvh.h>

#include <Imath/ImathBox.h>

#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

namespace vmap {
namespace {

using Imath::Box3f;
using Imath::V3f;

constexpr std::size_t width = PolygonBvh::width;
constexpr std::size_t parallel_polygons = 4096;  ///< ranges below it are split by the thread that has them

/// Polygons [begin, end) of the build order.
struct Range {
    std::size_t begin = 0;
    std::size_t end = 0;
    Box3f bounds;

    [[nodiscard]] std::size_t size() const { return end - begin; }
};

/// A wide node before it has its place in the flat array.
struct PlannedNode {
    std::vector<Range> ranges;
    std::vector<std::unique_ptr<PlannedNode>> children;  ///< one per range; null where the range is one block
};

float half_surface(const Box3f& box) {
    if (box.isEmpty()) return 0;
    const V3f d = box.size();
    return d.x * d.y + d.y * d.z + d.z * d.x;
}

class Builder {
public:
    explicit Builder(std::vector<Box3f> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
        std::iota(order_.begin(), order_.end(), 0U);
    }

    std::unique_ptr<PlannedNode> plan() { return plan_node(make_range(0, order_.size())); }

    [[nodiscard]] std::span<const std::uint32_t> polygons(const Range& range) const {
        return std::span(order_).subspan(range.begin, range.size());
    }

private:
    Range make_range(std::size_t begin, std::size_t end) const {
        Range range{begin, end, {}};
        for (std::size_t i = begin; i < end; ++i) range.bounds.extendBy(boxes_[order_[i]]);
        return range;
    }

    std::unique_ptr<PlannedNode> plan_node(const Range& whole) {
        auto node = std::make_unique<PlannedNode>();
        node->ranges.push_back(whole);
        while (node->ranges.size() < width) {
            const auto cost = [](const Range& r) {
                return r.size() > width ? half_surface(r.bounds) * static_cast<float>(r.size()) : -1.0F;
            };
            auto widest = std::max_element(node->ranges.begin(), node->ranges.end(),
                                           [&](const Range& a, const Range& b) { return cost(a) < cost(b); });
            if (widest->size() <= width) break;
            const std::size_t middle = split(*widest);
            const Range right = make_range(middle, widest->end);
            *widest = make_range(widest->begin, middle);
            node->ranges.push_back(right);
        }
        node->children.resize(node->ranges.size());
        tbb::task_group group;
        for (std::size_t i = 0; i < node->ranges.size(); ++i) {
            if (node->ranges[i].size() <= width) continue;
            const auto descend = [this, &node, i] { node->children[i] = plan_node(node->ranges[i]); };
            if (node->ranges[i].size() > parallel_polygons)
                group.run(descend);
            else
                descend();
        }
        group.wait();
        return node;
    }

    /// Binned surface-area split of the range; the middle when the centres all but coincide.
    std::size_t split(const Range& range) {
        constexpr std::size_t bin_count = 16;
        Box3f centers;
        for (std::size_t i = range.begin; i < range.end; ++i) centers.extendBy(boxes_[order_[i]].center());

        float best_cost = std::numeric_limits<float>::max();
        int best_axis = -1;
        std::size_t best_bin = 0;
        const auto bin_of = [&](std::uint32_t polygon, int axis) {
            const float extent = centers.max[axis] - centers.min[axis];
            const float at = (boxes_[polygon].center()[axis] - centers.min[axis]) / extent;
            return std::min(static_cast<std::size_t>(at * bin_count), bin_count - 1);
        };
        for (int axis = 0; axis < 3; ++axis) {
            if (!(centers.max[axis] > centers.min[axis])) continue;
            std::array<Box3f, bin_count> bins;
            std::array<std::size_t, bin_count> counts{};
            for (std::size_t i = range.begin; i < range.end; ++i) {
                const std::size_t bin = bin_of(order_[i], axis);
                bins[bin].extendBy(boxes_[order_[i]]);
                ++counts[bin];
            }
            std::array<float, bin_count> left_cost{};
            Box3f left;
            std::size_t left_count = 0;
            for (std::size_t b = 0; b + 1 < bin_count; ++b) {
                left.extendBy(bins[b]);
                left_count += counts[b];
                left_cost[b] = half_surface(left) * static_cast<float>(left_count);
            }
            Box3f right;
            std::size_t right_count = 0;
            for (std::size_t b = bin_count - 1; b > 0; --b) {
                right.extendBy(bins[b]);
                right_count += counts[b];
                const float cost = left_cost[b - 1] + half_surface(right) * static_cast<float>(right_count);
                if (right_count > 0 && right_count < range.size() && cost < best_cost) {
                    best_cost = cost;
                    best_axis = axis;
                    best_bin = b;
                }
            }
        }
        if (best_axis < 0) return range.begin + range.size() / 2;
        const auto begin = order_.begin() + static_cast<std::ptrdiff_t>(range.begin);
        const auto end = order_.begin() + static_cast<std::ptrdiff_t>(range.end);
        const auto middle =
            std::partition(begin, end, [&](std::uint32_t polygon) { return bin_of(polygon, best_axis) < best_bin; });
        return static_cast<std::size_t>(middle - order_.begin());
    }

    std::vector<Box3f> boxes_;
    std::vector<std::uint32_t> order_;
};

/// Plane of a polygon by Newell's method: robust for slivers and many vertices. A zero normal when it has no area.
V3f polygon_normal(std::span<const V3f> vertices) {
    Imath::V3d sum(0);
    for (std::size_t i = 1; i + 1 < vertices.size(); ++i)
        sum += Imath::V3d(vertices[i] - vertices[0]).cross(Imath::V3d(vertices[i + 1] - vertices[0]));
    const double length = sum.length();
    return length > 0 ? V3f(sum / length) : V3f(0);
}

/// Writes polygon p into lane of the block and its edges. A polygon without area stays a plane that no ray meets.
void fill_lane(std::span<const V3f> vertices, float dilation, std::size_t lane, PolygonBvh::Block& block,
               std::span<PolygonBvh::Edges> edges) {
    const V3f normal = polygon_normal(vertices);
    V3f center(0);
    for (const V3f& v : vertices) center += v;
    center /= static_cast<float>(vertices.size());
    for (std::size_t axis = 0; axis < 3; ++axis) block.normal[axis][lane] = normal[static_cast<int>(axis)];
    block.offset[lane] = normal.dot(center);

    for (std::size_t i = 0; i < edges.size(); ++i) {
        V3f inward(0);
        float offset = -1;  // a spare edge lets everything pass
        if (i < vertices.size()) {
            const V3f& a = vertices[i];
            const V3f& b = vertices[(i + 1) % vertices.size()];
            inward = normal.cross(b - a);
            const float length = inward.length();
            if (length > 0) {
                inward /= length;
                offset = inward.dot(a) - dilation;
            }
        }
        for (std::size_t axis = 0; axis < 3; ++axis) edges[i].normal[axis][lane] = inward[static_cast<int>(axis)];
        edges[i].offset[lane] = offset;
    }
}

}  // namespace

PolygonBvh::PolygonBvh(const PolygonSet& polygons, const PolygonBvhConfig& config) {
    if (polygons.empty()) return;
    Box3f world;
    for (std::size_t p = 0; p < polygons.size(); ++p)
        for (const V3f& v : polygons[p]) world.extendBy(v);
    // Coordinates carry 24 bits: some units in the last place of the largest one.
    float largest = 0;
    for (int axis = 0; axis < 3; ++axis)
        largest = std::max({largest, std::abs(world.min[axis]), std::abs(world.max[axis])});
    const float rounding = largest * 4e-7F;
    coincidence_ = largest * 2e-6F;

    const auto dilation = [&](std::size_t p) {
        return rounding + (config.dilation.empty() ? 0.0F : config.dilation[p]);
    };
    std::vector<Box3f> boxes(polygons.size());
    tbb::parallel_for(std::size_t{0}, polygons.size(), [&](std::size_t p) {
        for (const V3f& v : polygons[p]) boxes[p].extendBy(v);
        const V3f margin(dilation(p) * 1.5F);
        boxes[p].min -= margin;
        boxes[p].max += margin;
    });
    Builder builder(std::move(boxes));
    const std::unique_ptr<PlannedNode> root = builder.plan();

    // Lay the plan out depth first; blocks are filled afterwards, all at once.
    std::vector<Range> block_ranges;
    const auto lay_out = [&](const auto& self, const PlannedNode& planned) -> std::uint32_t {
        const auto index = static_cast<std::uint32_t>(nodes_.size());
        nodes_.emplace_back();
        Node node;
        for (std::size_t lane = 0; lane < width; ++lane) {
            node.child[lane] = no_child;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                node.lower[axis][lane] = std::numeric_limits<float>::max();
                node.upper[axis][lane] = std::numeric_limits<float>::lowest();
            }
        }
        for (std::size_t lane = 0; lane < planned.ranges.size(); ++lane) {
            const Range& range = planned.ranges[lane];
            for (std::size_t axis = 0; axis < 3; ++axis) {
                node.lower[axis][lane] = range.bounds.min[static_cast<int>(axis)];
                node.upper[axis][lane] = range.bounds.max[static_cast<int>(axis)];
            }
            if (planned.children[lane]) {
                node.child[lane] = self(self, *planned.children[lane]);
            } else {
                node.child[lane] = leaf_bit | static_cast<std::uint32_t>(block_ranges.size());
                block_ranges.push_back(range);
            }
        }
        nodes_[index] = node;
        return index;
    };
    lay_out(lay_out, *root);

    blocks_.resize(block_ranges.size());
    std::uint32_t edge_total = 0;
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
        std::size_t edge_count = 0;
        for (const std::uint32_t p : builder.polygons(block_ranges[b]))
            edge_count = std::max(edge_count, polygons[p].size());
        blocks_[b].first_edge = edge_total;
        blocks_[b].edge_count = static_cast<std::uint32_t>(edge_count);
        edge_total += blocks_[b].edge_count;
    }
    edges_.resize(edge_total);
    tbb::parallel_for(std::size_t{0}, blocks_.size(), [&](std::size_t b) {
        Block& block = blocks_[b];
        block.normal = {};
        block.offset = {};
        block.polygon.fill(RayHit::miss);
        const std::span<Edges> edges = std::span(edges_).subspan(block.first_edge, block.edge_count);
        for (Edges& e : edges) e = {{}, {}};
        std::size_t lane = 0;
        for (const std::uint32_t p : builder.polygons(block_ranges[b])) {
            fill_lane(polygons[p], dilation(p), lane, block, edges);
            block.polygon[lane++] = p;
        }
    });
}

}  // namespace vmap
