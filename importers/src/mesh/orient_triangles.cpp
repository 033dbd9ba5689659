// SPDX-License-Identifier: GPL-3.0-or-later
#include "orient_triangles.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <compare>
#include <tuple>
#include <utility>

namespace vmap {
namespace {

/// One side of a triangle, with its ends in order.
struct Side {
    std::uint32_t low = 0;
    std::uint32_t high = 0;
    std::uint32_t triangle = 0;
    bool upwards = false;  ///< runs from low to high

    friend auto operator<=>(const Side&, const Side&) = default;
};

std::vector<Side> sorted_sides(std::span<const IndexTriangle> triangles) {
    std::vector<Side> sides;
    sides.reserve(triangles.size() * 3);
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t from = triangles[t][k];
            const std::uint32_t to = triangles[t][(k + 1) % 3];
            sides.push_back({std::min(from, to), std::max(from, to), static_cast<std::uint32_t>(t), from < to});
        }
    tbb::parallel_sort(sides.begin(), sides.end());
    return sides;
}

/// Two triangles that share an edge, and whether one of them is to be turned for them to agree.
struct Link {
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    bool opposed = false;
};

/// Both directions of every link, sorted by `from`.
std::vector<Link> find_links(const std::vector<Side>& sides) {
    std::vector<Link> links;
    for (std::size_t begin = 0; begin < sides.size();) {
        std::size_t end = begin + 1;
        while (end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high) ++end;
        if (end - begin == 2 && sides[begin].triangle != sides[begin + 1].triangle) {
            const bool opposed = sides[begin].upwards == sides[begin + 1].upwards;
            links.push_back({sides[begin].triangle, sides[begin + 1].triangle, opposed});
            links.push_back({sides[begin + 1].triangle, sides[begin].triangle, opposed});
        }
        begin = end;
    }
    tbb::parallel_sort(links.begin(), links.end(), [](const Link& a, const Link& b) {
        return std::tie(a.from, a.to, a.opposed) < std::tie(b.from, b.to, b.opposed);
    });
    return links;
}

/// Walks over one connected piece after the other.
class PieceWalk {
public:
    PieceWalk(std::size_t triangles, const std::vector<Link>& links)
        : links_(links), first_link_(triangles + 1), seen_(triangles) {
        for (const Link& link : links) ++first_link_[link.from + 1];
        for (std::size_t i = 0; i < triangles; ++i) first_link_[i + 1] += first_link_[i];
        result_.flip.resize(triangles);
    }

    Orientation run() {
        for (std::uint32_t t = 0; t < seen_.size(); ++t)
            if (!seen_[t]) walk(t);
        result_.unorientable /= 2;
        return std::move(result_);
    }

private:
    void walk(std::uint32_t seed) {
        std::vector<std::uint32_t> piece{seed};
        seen_[seed] = true;
        std::size_t flips = 0;
        for (std::size_t i = 0; i < piece.size(); ++i) {
            const std::uint32_t t = piece[i];
            for (std::size_t l = first_link_[t]; l < first_link_[t + 1]; ++l) {
                const bool wanted = result_.flip[t] != links_[l].opposed;
                const std::uint32_t other = links_[l].to;
                if (seen_[other]) {
                    if (result_.flip[other] != wanted) ++result_.unorientable;
                    continue;
                }
                seen_[other] = true;
                result_.flip[other] = wanted;
                flips += wanted ? 1 : 0;
                piece.push_back(other);
            }
        }
        if (2 * flips > piece.size()) {
            for (const std::uint32_t t : piece) result_.flip[t] = !result_.flip[t];
            flips = piece.size() - flips;
        }
        result_.flipped += flips;
    }

    const std::vector<Link>& links_;
    std::vector<std::size_t> first_link_;
    std::vector<bool> seen_;
    Orientation result_;
};

}  // namespace

Orientation orient_triangles(std::span<const IndexTriangle> triangles) {
    return PieceWalk(triangles.size(), find_links(sorted_sides(triangles))).run();
}

}  // namespace vmap
