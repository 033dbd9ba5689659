// SPDX-License-Identifier: Apache-2.0
#include "octree_grid.h"
#include "octree_leaves.h"

#include <vmap/error.h>
#include <vmap/octree.h>

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace vmap {
namespace {

struct Item {
    std::uint64_t key;
    std::uint32_t point;
};

/// A node whose points are still to be parted by the digit of a level; level 0 is the orientation class.
struct Pending {
    std::uint32_t node;
    std::uint32_t first;
    std::uint32_t count;
    std::uint32_t first_piece;  ///< its share of the round's pieces
};

/// A run of one pending node's items, small enough to be one task.
struct Piece {
    std::uint32_t pending;
    std::uint32_t begin;
    std::uint32_t end;
    std::array<std::uint32_t, 8> digits;  ///< first the items of each digit, then where the next of them goes
};

constexpr std::uint32_t piece_size = 1 << 14;

/// Parts all points level by level, stably and in fixed pieces, so that the order never depends on the threads.
class OctreeSplit {
public:
    OctreeSplit(const PointCloud& cloud, const OctreeGrid& grid, const OctreeConfig& config)
        : grid_(grid), config_(config), items_(cloud.size()), parted_(cloud.size()) {
        tree_.point_order.resize(cloud.size());
        tbb::parallel_for(std::size_t{0}, cloud.size(), [&](std::size_t i) {
            items_[i] = {grid.key(cloud.positions[i], cloud.normals[i]), static_cast<std::uint32_t>(i)};
            tree_.point_order[i] = static_cast<std::uint32_t>(i);
        });
    }

    Tree run() {
        const auto count = static_cast<std::uint32_t>(items_.size());
        tree_.nodes.emplace_back().point_count = count;
        pending_.push_back({0, 0, count, 0});
        for (int level = 0; level <= grid_.levels && !pending_.empty(); ++level) {
            cut_into_pieces();
            count_digits(level);
            make_children(level);
            move_items(level);
            items_.swap(parted_);
            pending_.swap(next_);
            next_.clear();
        }
        return std::move(tree_);
    }

private:
    [[nodiscard]] unsigned digit(const Item& item, int level) const {
        return item.key >> (3 * (grid_.levels - level)) & 7;
    }

    /// Whether a node needs no further cells once its points share this level's digit.
    [[nodiscard]] bool is_done(std::uint32_t count, int level) const {
        if (level == grid_.levels) return true;
        return config_.kind == OctreeKind::adaptive && count <= std::max(config_.points_per_leaf, 1U);
    }

    void cut_into_pieces() {
        pieces_.clear();
        for (std::uint32_t p = 0; p < pending_.size(); ++p) {
            pending_[p].first_piece = static_cast<std::uint32_t>(pieces_.size());
            const std::uint32_t end = pending_[p].first + pending_[p].count;
            for (std::uint32_t begin = pending_[p].first; begin < end; begin += std::min(piece_size, end - begin))
                pieces_.push_back({p, begin, begin + std::min(piece_size, end - begin), {}});
        }
    }

    void count_digits(int level) {
        tbb::parallel_for(std::size_t{0}, pieces_.size(), [&](std::size_t i) {
            Piece& piece = pieces_[i];
            for (std::uint32_t at = piece.begin; at < piece.end; ++at) ++piece.digits[digit(items_[at], level)];
        });
    }

    void make_children(int level) {
        for (std::uint32_t p = 0; p < pending_.size(); ++p) {
            const Pending& parent = pending_[p];
            const std::uint32_t end_piece =
                p + 1 < pending_.size() ? pending_[p + 1].first_piece : static_cast<std::uint32_t>(pieces_.size());

            std::array<std::uint32_t, 8> counts{};
            std::uint32_t at = parent.first;
            for (unsigned d = 0; d < 8; ++d)
                for (std::uint32_t i = parent.first_piece; i < end_piece; ++i) {
                    counts[d] += pieces_[i].digits[d];
                    at += std::exchange(pieces_[i].digits[d], at);
                }

            const auto child_count = static_cast<std::uint32_t>(8 - std::ranges::count(counts, 0U));
            if (child_count == 1) {  // all in one octant: the node goes on as it is
                if (!is_done(parent.count, level)) next_.push_back(parent);
                continue;
            }
            tree_.nodes[parent.node].first_child = static_cast<std::uint32_t>(tree_.nodes.size());
            tree_.nodes[parent.node].child_count = child_count;
            add_children(parent.first, counts, level);
        }
    }

    void add_children(std::uint32_t first, const std::array<std::uint32_t, 8>& counts, int level) {
        for (const std::uint32_t count : counts) {
            if (count == 0) continue;
            const auto node = static_cast<std::uint32_t>(tree_.nodes.size());
            if (!is_done(count, level)) next_.push_back({node, first, count, 0});
            TreeNode& child = tree_.nodes.emplace_back();
            child.first_point = first;
            child.point_count = count;
            first += count;
        }
    }

    void move_items(int level) {
        tbb::parallel_for(std::size_t{0}, pieces_.size(), [&](std::size_t i) {
            Piece& piece = pieces_[i];
            for (std::uint32_t at = piece.begin; at < piece.end; ++at) {
                const std::uint32_t to = piece.digits[digit(items_[at], level)]++;
                parted_[to] = items_[at];
                tree_.point_order[to] = items_[at].point;
            }
        });
    }

    const OctreeGrid& grid_;
    const OctreeConfig& config_;
    std::vector<Item> items_;
    std::vector<Item> parted_;
    std::vector<Pending> pending_;
    std::vector<Pending> next_;
    std::vector<Piece> pieces_;
    Tree tree_;
};

}  // namespace

Tree build_octree(const PointCloud& cloud, const OctreeConfig& config) {
    if (cloud.size() >= no_index) throw UnsupportedInput("the cloud has more than 4294967294 points");
    const OctreeGrid grid = make_octree_grid(cloud, config);
    if (cloud.empty()) return {};
    Tree tree = OctreeSplit(cloud, grid, config).run();
    finish_octree(cloud, grid, config.kind, tree);
    return tree;
}

OctreeConfig octree_config_for_leaves(const PointCloud& cloud, OctreeKind kind, std::size_t leaves) {
    OctreeConfig best{.kind = kind, .cell_size = 1, .points_per_leaf = 0};
    const double extent = cloud_extent(cloud);
    if (!(extent > 0)) return best;

    std::size_t best_miss = no_index;
    const auto try_size = [&](double log_size) {
        OctreeConfig trial = best;
        trial.cell_size = std::max(std::exp(log_size), extent / 1000);
        const std::size_t count = build_octree(cloud, trial).leaves.size();
        const std::size_t miss = count > leaves ? count - leaves : leaves - count;
        if (miss < best_miss) {
            best_miss = miss;
            best = trial;
        }
        return count;
    };

    // Leaves fall with the cell size, up to the luck of where the borders of the cells lie: bisect, then look around.
    double low = std::log(extent / 900);
    double high = std::log(extent * 1.1);
    for (int step = 0; step < 12 && best_miss > 0; ++step) {
        const double middle = (low + high) / 2;
        (try_size(middle) > leaves ? low : high) = middle;
    }
    for (int step = -8; step <= 8 && best_miss > leaves / 200; ++step) try_size((low + high) / 2 + 0.02 * step);
    return best;
}

}  // namespace vmap
